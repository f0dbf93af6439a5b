//! What the documentation quotes of a command's output is what the command prints today.
//!
//! A quotation is a block of Markdown. Its lines stand in the output in the same order, apart from times; `…` stands for anything that is left out,
//! between lines and within one. Commands that take minutes, other machines or renderers to be installed are quoted too, and not run here.

use super::{command, folder, stderr, stdout};
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;

/// A quotation: the page, how its block begins, the command, and what it reads.
struct Quotation {
    page: &'static str,
    begins: &'static str,
    args: &'static [&'static str],
    /// The line of the block, or how another block begins, that the command reads.
    reads: Option<&'static str>,
    /// A file that the command reads, and how the block begins that it is.
    file: Option<(&'static str, &'static str)>,
}

const fn of(page: &'static str, begins: &'static str, args: &'static [&'static str]) -> Quotation {
    Quotation { page, begins, args, reads: None, file: None }
}

const fn eval(page: &'static str, begins: &'static str, reads: &'static str) -> Quotation {
    Quotation { page, begins, args: &["eval"], reads: Some(reads), file: None }
}

const QUOTATIONS: &[Quotation] = &[
    Quotation {
        file: Some(("fog.glsl", "vec3 applyFog(")),
        ..of(
            "docs/book/what-it-tells-you.md",
            "✗ fog/exp2-opengl on lavapipe",
            &["run", "fog/exp2-opengl", "--function", "applyFog@fog.glsl"],
        )
    },
    of(
        "docs/book/a-rasterisers-freedom.md",
        "lightmeter run interpolation/raster-top-left",
        &["run", "interpolation/raster-top-left", "interpolation/raster-shared-edge"],
    ),
    eval("docs/book/a-rasterisers-freedom.md", "echo '{\"id\":1,\"formula\":\"interpolation/perspective\"", "echo '"),
    eval("docs/book/floats-and-what-is-legal.md", "echo '{\"id\":1,\"formula\":\"fog/exp\"", "echo '"),
    eval("docs/book/gouraud-and-highlights.md", "{\"id\":\"gouraud\",\"value\"", "{\"id\":\"gouraud\",\"formula\""),
    of(
        "docs/book/floats-and-what-is-legal.md",
        "lightmeter sweep fog/exp --over p.z --from -8",
        &["sweep", "fog/exp", "--over", "p.z", "--from", "-8", "--to", "-8", "--set", "density=0.0625"],
    ),
    of(
        "docs/book/floats-and-what-is-legal.md",
        "lightmeter sweep fog/exp --over density",
        &["sweep", "fog/exp", "--over", "density", "--from", "0x3d392a74", "--to", "0x3d392a74", "--set", "p.z=-1"],
    ),
    of(
        "docs/book/my-driver.md",
        "over       every p.z from 1 to 2",
        &["sweep", "fog/exp", "--from", "1", "--to", "2", "--adapter", "lavapipe"],
    ),
    of("docs/book/what-it-tells-you.md", "    hard/dmin-equals-dmax", &["list", "fog/linear/hard"]),
    of("docs/book/what-it-tells-you.md", "✓  fog     compute", &["run", "fog/exp/random", "-v"]),
    of(
        "docs/book/floats-and-what-is-legal.md",
        "steps                f64",
        &["show", "fog/exp/random/000017", "--mistake", "fog-radial"],
    ),
    of(
        "docs/book/floats-and-what-is-legal.md",
        "lavapipe, fixed-function on rgba16float",
        &["show", "blend/add/src-alpha/one-minus-src-alpha/0300", "--target", "rgba8unorm", "--target", "rgba16float"],
    ),
    of("docs/book/my-shader.md", "✓  blend   rgba32float", &["run", "--blend", "glBlendFunc(GL_SRC_ALPHA, GL_ONE)"]),
    of(
        "docs/shaders.md",
        "conformance/examples/shaders/mistakes/half-vector-mean.frag: GLSL",
        &["check", "conformance/examples/shaders/mistakes/half-vector-mean.frag"],
    ),
    of(
        "docs/shaders.md",
        "half-vector-mean.frag is judged as",
        &["run", "lighting/blinn", "--shader", "conformance/examples/shaders/mistakes/half-vector-mean.frag"],
    ),
    of(
        "docs/shaders.md",
        "half-vector-mean.frag:16",
        &["run", "lighting/blinn", "--shader", "conformance/examples/shaders/mistakes/half-vector-mean.frag"],
    ),
];

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// The block of a page that begins so.
fn block(page: &str, begins: &str) -> String {
    let text = std::fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"));
    let blocks = text.split("```").skip(1).step_by(2).filter_map(|block| block.split_once('\n'));
    let mut found = blocks.map(|(_, lines)| lines.to_owned()).filter(|lines| lines.starts_with(begins));
    found.next().unwrap_or_else(|| panic!("{page} has no block that begins with `{begins}`"))
}

/// What a command prints on both streams.
fn printed(quotation: &Quotation, given: &str) -> String {
    let mut asked = command(quotation.args);
    if let Some((name, begins)) = quotation.file {
        let folder = folder("quoted");
        std::fs::write(folder.join(name), block(quotation.page, begins)).expect("it can be written");
        asked.current_dir(&folder);
    } else {
        asked.current_dir(root());
    }
    asked.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut running = asked.spawn().expect("the binary starts");
    running.stdin.take().expect("it is piped").write_all(given.as_bytes()).expect("it reads");
    let output = running.wait_with_output().expect("it ends");
    stdout(&output) + &stderr(&output)
}

/// A line without times and rates, and with single spaces: what is measured differs each time.
fn timeless(line: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    let is_time = |k: usize| {
        let unit =
            words.get(k + 1).is_some_and(|next| next.starts_with("s:") || *next == "s" || next.starts_with("s,"));
        unit && words[k].parse::<f64>().is_ok()
    };
    (0..words.len()).map(|k| if is_time(k) { "TIME" } else { words[k] }).collect::<Vec<_>>().join(" ")
}

/// Whether what is quoted between signs of omission stands in a line in the same order.
fn is_in(quoted: &str, line: &str) -> bool {
    let mut rest = line;
    quoted.split('…').all(|part| match rest.find(part.trim()) {
        Some(at) => {
            rest = &rest[at + part.trim().len()..];
            true
        }
        None => false,
    })
}

#[test]
#[ignore = "long: ./x campaign long"]
fn what_the_documentation_quotes_is_what_commands_print() {
    if crate::needs::lacks_recorded_lavapipe() {
        return;
    }
    let mut wrong = vec![];
    for quotation in QUOTATIONS {
        let block = block(quotation.page, quotation.begins);
        let given = match quotation.reads {
            Some("echo '") => block.split('\'').nth(1).expect("it is quoted").to_owned() + "\n",
            Some(begins) => self::block(quotation.page, begins),
            None => String::new(),
        };
        let printed: Vec<String> = printed(quotation, &given).lines().map(timeless).collect();
        let mut at = 0;
        let is_command = |line: &&str| line.starts_with("lightmeter ") || line.starts_with("echo ");
        for line in
            block.lines().filter(|line| !is_command(line)).map(timeless).filter(|line| !matches!(&**line, "" | "…"))
        {
            match printed[at..].iter().position(|own| is_in(&line, own)) {
                Some(place) => at += place + 1,
                None => {
                    let word = line.split_whitespace().next().unwrap_or_default();
                    let near =
                        printed.iter().find(|own| own.starts_with(word)).map_or("nothing like it", String::as_str);
                    wrong.push(format!("{} quotes\n    {line}\n  and the command prints\n    {near}", quotation.page));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_quotation_may_leave_out_and_may_not_differ() {
    assert!(is_in("\"value\":[0.6,…],\"low\"", "{\"value\":[0.6,0.7],\"low\":[0]}"));
    assert!(!is_in("worst 0.11 ULP", "worst 0.12 ULP: legal there"));
    assert_eq!(timeless("✓ 8 verdicts  in 0.7 s: 0 failed"), "✓ 8 verdicts in TIME s: 0 failed");
}
