//! Columns: packs and answers as arrays of NumPy's format, and a process that is asked in binary batches.

use super::process::{command_of, process};
use super::{count, folder, report, text};
use crate::{code, lightmeter, stderr};
use lightmeter::select::catalogue;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const FORMULAS: [&str; 3] = ["fog/exp", "vector/reflect", "lighting/blinn"];

/// An array of f32 in NumPy's format, version 1.
fn array(shape: &str, dtype: &str, order: bool, data: &[u8]) -> Vec<u8> {
    let order = if order { "True" } else { "False" };
    let mut header = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': {shape}, }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let length = u16::try_from(header.len()).expect("it is short");
    [b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], header.as_bytes(), data].concat()
}

/// The numbers of such a file.
fn numbers(path: &Path) -> Vec<f32> {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!(start % 64, 0, "{}", path.display());
    bytes[start..].chunks_exact(4).map(|part| f32::from_le_bytes(part.try_into().expect("four bytes"))).collect()
}

/// A pack of columns, and the answers of the embedded implementation to it, in f32 or in f64.
fn answered(test: &str, is_wide: bool) -> (PathBuf, PathBuf) {
    let folder = folder(test);
    let (pack, answers) = (folder.join("pack"), folder.join("answers"));
    let output = lightmeter(&[&["pack", text(&pack), "--columns", "--cases", "64"], &FORMULAS[..]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let manifest = std::fs::read_to_string(pack.join("manifest.json")).expect("there is a manifest");
    let manifest: Value = serde_json::from_str(&manifest).expect("it is JSON");
    assert_eq!(manifest["columns"], true);
    let members = catalogue();
    for formula in manifest["formulas"].as_array().expect("formulas") {
        let id = formula["id"].as_str().expect("an id");
        let member = members.iter().find(|member| member.spec.id == id).expect("it is in the catalogue");
        let rows = usize::try_from(formula["count"].as_u64().expect("a count")).expect("a few");
        let columns: Vec<(usize, Vec<f32>)> = member
            .spec
            .inputs
            .iter()
            .map(|input| {
                let numbers = numbers(&pack.join(format!("columns/{id}/{}.npy", input.name)));
                assert_eq!(numbers.len(), rows * input.shape.components());
                (input.shape.components(), numbers)
            })
            .collect();
        let mut outputs = vec![vec![]; member.spec.outputs.len()];
        for row in 0..rows {
            let inputs: Vec<f32> =
                columns.iter().flat_map(|(size, column)| column[row * size..(row + 1) * size].to_vec()).collect();
            let mut values = vec![0.0; member.spec.output_len()];
            member.formula.embedded(&inputs, &mut values);
            let mut rest = values.as_slice();
            for (output, column) in member.spec.outputs.iter().zip(&mut outputs) {
                let (own, after) = rest.split_at(output.shape.components());
                column.extend_from_slice(own);
                rest = after;
            }
        }
        std::fs::create_dir_all(answers.join("columns").join(id)).expect("a folder can be made");
        for (output, column) in member.spec.outputs.iter().zip(outputs) {
            let components = output.shape.components();
            let shape = if components == 1 { format!("({rows},)") } else { format!("({rows}, {components})") };
            let data: Vec<u8> = column
                .iter()
                .flat_map(|x| if is_wide { f64::from(*x).to_le_bytes().to_vec() } else { x.to_le_bytes().to_vec() })
                .collect();
            let file = array(&shape, if is_wide { "<f8" } else { "<f4" }, false, &data);
            std::fs::write(answers.join(format!("columns/{id}/{}.npy", output.name)), file).expect("it can be written");
        }
    }
    hello(&answers, &json!({ "renderer": "columns", "formulas": ["**"], "pack": manifest["pack"] }));
    (pack, answers)
}

fn hello(answers: &Path, hello: &Value) {
    std::fs::write(answers.join("answers.jsonl"), format!("{hello}\n")).expect("it can be written");
}

#[test]
fn columns_are_judged_as_lines_are() {
    let judged =
        |pack: &Path, answers: &Path| report(&lightmeter(&["gate", text(pack), text(answers), "--format", "json"]));
    let (lines, told) = super::answered("columns-as-lines", &FORMULAS);
    let (status, by_lines) = judged(&lines, &told);
    assert_eq!(status, 0, "{by_lines}");
    for is_wide in [false, true] {
        let (pack, answers) = answered(if is_wide { "columns-f8" } else { "columns-f4" }, is_wide);
        let (status, report) = judged(&pack, &answers);
        assert_eq!(status, 0, "{report}");
        for what in ["asked", "passed"] {
            assert_eq!(count(&report, what), count(&by_lines, what), "{what}");
        }
        // One number is wrong, and its case alone fails.
        let path = answers.join("columns/fog/exp/f.npy");
        let mut bytes = std::fs::read(&path).expect("it is there");
        let last = bytes.len() - if is_wide { 8 } else { 4 };
        let wrong = if is_wide { 7.0_f64.to_le_bytes().to_vec() } else { 7.0_f32.to_le_bytes().to_vec() };
        bytes[last..].copy_from_slice(&wrong);
        std::fs::write(&path, bytes).expect("it can be written");
        let (status, report) = judged(&pack, &answers);
        assert_eq!((status, count(&report, "failed")), (1, 1), "{report}");
        assert!(report.to_string().contains("fog/exp/random/000063"), "{report}");
    }
}

#[test]
fn columns_that_do_not_fit_the_pack_are_refused_by_name() {
    let (pack, answers) = answered("columns-refused", false);
    let (f, color) = (answers.join("columns/fog/exp/f.npy"), answers.join("columns/fog/exp/color.npy"));
    let right = [std::fs::read(&f).expect("f"), std::fs::read(&color).expect("color")];
    let rows = numbers(&f).len();
    let (scalar, vector) = (vec![0; 4 * rows], vec![0; 12 * rows]);
    let refused = |said: &str| {
        let output = lightmeter(&["gate", text(&pack), text(&answers)]);
        let error = stderr(&output);
        assert_eq!(code(&output), 2, "{said}: {error}");
        assert!(error.contains(said), "{said}: {error}");
    };
    let shape = format!("({rows},)");
    let a_matrix = format!("its shape is [{rows}, 1]; expected [{rows}], as of f[:, 0]");
    let a_row = format!("its shape is [{}]; expected [{rows}, 3]", 3 * rows);
    for (path, file, said) in [
        (&f, array(&shape, "<i4", false, &scalar), "its numbers are '<i4'; expected <f4 or <f8"),
        (&f, array("(3,)", "<f4", false, &[0; 12]), "its shape is [3]; expected"),
        (&color, array(&format!("(3, {rows})"), "<f4", false, &vector), "its shape is [3, "),
        (&f, array(&format!("({rows}, 1)"), "<f4", false, &scalar), &a_matrix),
        (&color, array(&format!("({},)", 3 * rows), "<f4", false, &vector), &a_row),
        (&color, array(&format!("({rows}, 3)"), "<f4", true, &vector), "Fortran's order"),
        (&f, array(&shape, "<f4", false, &scalar[4..]), "bytes; expected"),
        (&f, b"numbers".to_vec(), "it is no array"),
    ] {
        std::fs::write(path, file).expect("it can be written");
        refused(said);
        std::fs::write(&f, &right[0]).expect("it can be written");
        std::fs::write(&color, &right[1]).expect("it can be written");
    }
    std::fs::remove_file(&f).expect("it was there");
    refused("`f.npy` is missing; expected f.npy, color.npy");
    std::fs::write(&f, &right[0]).expect("it can be written");
    let other = answers.join("columns/fog/exp/g.npy");
    std::fs::write(&other, &right[0]).expect("it can be written");
    refused("`g.npy` is no output; expected f.npy, color.npy");
    std::fs::remove_file(&other).expect("it was there");
    let unknown = answers.join("columns/fog/none");
    std::fs::create_dir_all(&unknown).expect("a folder can be made");
    std::fs::write(unknown.join("f.npy"), &right[0]).expect("it can be written");
    refused("the pack has no formula `fog/none`");
    std::fs::remove_dir_all(&unknown).expect("it was there");
    hello(&answers, &json!({ "renderer": "columns", "formulas": ["**"], "pack": "00000000" }));
    refused("its hello says that it answers the pack `00000000`; this pack is `");
    hello(&answers, &json!({ "renderer": "columns", "formulas": ["**"] }));
    refused("its hello does not say which pack it answers");
}

#[test]
fn a_case_in_columns_and_in_a_line_is_answered_twice() {
    let (pack, answers) = answered("columns-twice", false);
    let path = answers.join("answers.jsonl");
    let line = r#"{"id": "fog/exp/random/000000", "value": [0, 0, 0, 0]}"#;
    let text_of = std::fs::read_to_string(&path).expect("it is there");
    std::fs::write(&path, format!("{text_of}{line}\n")).expect("it can be written");
    let (status, report) = report(&lightmeter(&["gate", text(&pack), text(&answers), "--format", "json"]));
    assert_eq!(status, 4, "{report}");
    assert!(report.to_string().contains("fog/exp/random/000000 is answered more than once"), "{report}");
}

#[test]
fn a_process_is_asked_in_columns() {
    let formulas = ["fog/exp", "vector/reflect", "blend/add/one/one"];
    let whole = report(&process(&formulas, "", &[])).1;
    for (way, status, said) in [
        ("f4", 0, ""),
        ("f8", 0, ""),
        ("lines", 0, ""),
        ("wrong", 1, ""),
        ("skips", 1, "not built"),
        ("errors", 1, "no memory"),
        ("crash", 4, "cases asked in columns it ended"),
        ("hang", 4, "cases asked in columns it took longer"),
        ("few", 4, "it took longer than a case may: it announced "),
        ("unended", 4, "bytes came behind the line of an answer in columns, and no newline between; expected one"),
    ] {
        let output = process(&formulas, &format!("columns={way}"), &[]);
        let (found, report) = report(&output);
        assert_eq!(found, status, "{way}: {report}");
        assert!(report.to_string().contains(said), "{way}: {report}");
        assert_eq!(count(&report, "asked"), count(&whole, "asked"), "{way}");
        if matches!(way, "f4" | "f8" | "lines" | "crash" | "hang" | "few" | "unended") {
            assert_eq!(count(&report, "passed"), count(&whole, "passed"), "{way}: {report}");
        } else {
            assert_eq!(count(&report, "passed"), 0, "{way}: {report}");
        }
        if matches!(way, "few" | "unended") {
            // One wait tells it: the next formula is asked by lines at once.
            assert_eq!(report["renderer"]["incidents"].as_array().map(Vec::len), Some(1), "{report}");
        }
    }
}

#[test]
fn a_formula_that_hangs_in_columns_is_waited_for_three_times() {
    // More cases than are judged at once.
    let renderer = command_of("columns=hang");
    let arguments = ["gate", "fog/exp", "--exec", &renderer, "--cases", "40000", "--format", "json"];
    let (status, report) = report(&lightmeter(&arguments));
    assert_eq!(status, 4, "{report}");
    assert_eq!(
        report["renderer"]["incidents"].as_array().map(Vec::len),
        Some(3),
        "{}",
        report["renderer"]["incidents"]
    );
}

#[test]
fn what_is_no_answer_in_columns_is_told_at_once_and_its_cases_are_asked_by_lines() {
    let formulas = ["fog/exp", "vector/reflect"];
    let whole = report(&process(&formulas, "", &[])).1;
    for (way, kind, said) in [
        ("short", "malformed", " bytes in columns; expected "),
        ("huge", "malformed", "its line announces 1000000000000000 bytes in columns; expected "),
        ("surplus", "malformed", "5 bytes stand before the line of its answer; expected none"),
        ("joined", "malformed", " bytes stand between the line of its answer and the newline; expected none"),
        ("type", "malformed", "its `dtype` is `<i4`; expected <f4 or <f8"),
        ("nothing", "malformed", "none, or more than one, of `bytes`, `skip`, `error` and `lines`"),
        ("both", "malformed", "none, or more than one, of `bytes`, `skip`, `error` and `lines`"),
        ("cases", "malformed", "answers a case; expected such as"),
        ("other", "unknown", "an answer of `fog/exp` in columns has no `batch`, or 0; expected the number"),
    ] {
        // No time passes: a gate that waited for what does not come would never end.
        let (status, report) = report(&process(&formulas, &format!("columns={way}"), &[]));
        let problems = &report["renderer"]["problems"];
        assert!(status == 4 && problems["counts"][kind].as_u64() >= Some(1), "{way}: {report}");
        assert!(problems.to_string().contains(said), "{way}: {problems}");
        assert_eq!((count(&report, "failed"), count(&report, "missing")), (0, 0), "{way}: {report}");
        assert_eq!(count(&report, "passed"), count(&whole, "passed"), "{way}: {report}");
    }
    // Behind the last array nothing waits for a line, and what stands there is told all the same.
    let (status, report) = report(&process(&["fog/exp/random"], "columns=surplus", &[]));
    assert!(
        status == 4 && report["renderer"]["problems"].to_string().contains("5 bytes behind the last answer"),
        "{report}"
    );
    assert_eq!(count(&report, "passed"), count(&report, "asked"), "{report}");
}

#[test]
fn rows_of_columns_are_skipped_by_a_line() {
    let (pack, answers) = answered("columns-skips", false);
    let judged = |more: &[Value]| {
        let manifest = std::fs::read_to_string(pack.join("manifest.json")).expect("there is a manifest");
        let manifest: Value = serde_json::from_str(&manifest).expect("it is JSON");
        let skips = json!([{ "id": "fog/exp", "reason": "known" }]);
        let hello = json!({ "renderer": "columns", "formulas": ["**"], "pack": manifest["pack"], "skips": skips });
        let lines: Vec<String> = std::iter::once(&hello).chain(more).map(|line| format!("{line}\n")).collect();
        std::fs::write(answers.join("answers.jsonl"), lines.concat()).expect("it can be written");
        report(&lightmeter(&["gate", text(&pack), text(&answers), "--format", "json"]))
    };
    let (status, report) = judged(&[json!({ "id": "fog/exp", "skip": "no fog", "rows": [0, 3] })]);
    assert_eq!((status, count(&report, "skipped"), &report["by_case"]["undeclared"]), (0, 2, &Value::Null), "{report}");
    let (status, report) = judged(&[json!({ "id": "vector/reflect", "skip": "none", "rows": [1] })]);
    assert_eq!((status, count(&report, "skipped"), count(&report, "undeclared")), (1, 1, 1), "{report}");
    for (line, kind, said) in [
        (json!({ "id": "fog/exp", "skip": "no fog" }), "duplicate", "names them by `rows`"),
        (
            json!({ "id": "fog/exp", "skip": "no fog", "rows": [1, 1] }),
            "duplicate",
            "row 1 of fog/exp is skipped more than once",
        ),
        (json!({ "id": "fog/exp", "skip": "no fog", "rows": [100_000] }), "unknown", "rows, counted from 0"),
        (json!({ "id": "fog/exp", "value": [1] }), "unknown", "is a formula; expected the id of a case"),
    ] {
        let (status, report) = judged(&[line]);
        let problems = &report["renderer"]["problems"];
        assert!(status == 4 && problems["counts"][kind] == 1 && problems.to_string().contains(said), "{problems}");
    }
    // One row by two lines: both lines are of answers, and the first holds.
    let skip = json!({ "id": "fog/exp", "skip": "no fog", "rows": [4, 5] });
    let (status, report) = judged(&[skip.clone(), skip]);
    assert_eq!((status, count(&report, "skipped")), (4, 2), "{report}");
    assert!(
        report["renderer"]["problems"].to_string().contains("line 3: row 4 of fog/exp is skipped more than once"),
        "{report}"
    );
}
