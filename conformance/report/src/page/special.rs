//! The page on NaN, infinity, subnormals and signed zero, made from the JSON of `lightmeter special`.

use lightmeter_document::Document as _;
use lightmeter_document::report::Identity;
use lightmeter_document::special::{ProbeClass, ProbeResult, ProbeRow, ProbeSource, SpecialReport};
use std::fmt::{Result as Written, Write};
use std::ops::Deref;

/// What was probed.
#[derive(Clone, Debug)]
pub struct SpecialRun(SpecialReport);

impl Deref for SpecialRun {
    type Target = SpecialReport;

    fn deref(&self) -> &SpecialReport {
        &self.0
    }
}

impl SpecialRun {
    /// Reads the JSON.
    ///
    /// # Errors
    /// Where it is another document or interrupted, or does not describe its probes.
    pub fn read(json: &str) -> Result<Self, String> {
        let run = Self(SpecialReport::read(json).map_err(|error| error.to_string())?);
        if let Some(interrupted) = &run.interrupted {
            return Err(format!("it was interrupted: {interrupted}; expected one that is complete"));
        }
        if run.outcomes.is_empty() {
            return Err("nothing was probed".into());
        }
        if run.classes.is_empty() || run.sources.is_empty() {
            return Err("it does not name its rules, as older versions did not; run the probes anew".into());
        }
        match run.outcomes.iter().find(|outcome| run.probe(&outcome.probe).is_none()) {
            Some(outcome) => Err(format!("it does not describe the probe `{}`", outcome.probe)),
            None => Ok(run),
        }
    }

    /// Probes whose results differ between the stages of an adapter.
    fn by_stage(&self, adapter: &Identity) -> usize {
        let differs = |probe: &&ProbeRow| {
            let mut values = self.of(&probe.name, &adapter.name).map(|outcome| &outcome.value);
            let first = values.next();
            values.any(|value| Some(value) != first)
        };
        self.probes.iter().filter(differs).count()
    }
}

/// The page in Markdown.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(run: &SpecialRun, out: &mut impl Write) -> Written {
    writeln!(out, "# NaN, infinity, subnormals and signed zero\n")?;
    writeln!(out, "What the shading language promises of them, and what each driver does. Made from a run's JSON:\n")?;
    writeln!(out, "```\n./x special --adapter all --format json --out special.json")?;
    writeln!(out, "./x page special special.json --out docs/special-values.md\n```\n")?;
    policy(run, out)?;
    drivers(run, out)?;
    for class in &run.classes {
        table(run, class, out)?;
    }
    Ok(())
}

fn policy(run: &SpecialRun, out: &mut impl Write) -> Written {
    writeln!(out, "## What is promised\n")?;
    writeln!(out, "| section | says |\n|---|---|")?;
    for ProbeSource { section, says } in &run.sources {
        writeln!(out, "| {section} | {says} |")?;
    }
    let definite = run.probes.iter().filter(|probe| probe.definite).count();
    writeln!(
        out,
        "\nA *probe* is one operation on operands that are known at run time alone. Of {} probes {definite} are promised",
        run.probes.len()
    )?;
    writeln!(
        out,
        "something, and another result fails. Of the others nothing is promised: the result is *indeterminate*."
    )?;
    writeln!(
        out,
        "What each driver gave is on record in `conformance/judge/records/special/`; where a driver tells its version, and it is the"
    )?;
    writeln!(out, "one on record, a result that changes fails by name.\n")?;
    for deviation in &run.deviations {
        writeln!(
            out,
            "Deviation *{}* of {}: {} ({}).\n",
            deviation.name,
            deviation.backend,
            deviation.reason,
            deviation.probes.join(", ")
        )?;
    }
    Ok(())
}

fn drivers(run: &SpecialRun, out: &mut impl Write) -> Written {
    writeln!(out, "## Drivers\n")?;
    writeln!(
        out,
        "| driver | | as promised | broken | deviates | indeterminate | changed | differ by stage |\n|---|---|--:|--:|--:|--:|--:|--:|"
    )?;
    for adapter in &run.adapters {
        let count = |verdict: &str| {
            run.outcomes.iter().filter(|o| o.adapter == adapter.name && o.verdict.name() == verdict).count()
        };
        writeln!(
            out,
            "| {} | {}, {}, {} | {} | {} | {} | {} | {} | {} |",
            adapter.name,
            adapter.device,
            adapter.backend,
            adapter.driver,
            count("kept"),
            count("broken"),
            count("deviates"),
            count("indeterminate"),
            count("changed"),
            run.by_stage(adapter)
        )?;
    }
    writeln!(
        out,
        "\nBelow, a result stands once where all stages agree, else as *compute* / *fragment*. ✗ is not as promised, ! is so by \
         a named\ndeviation, ≠ is not as on record."
    )
}

fn table(run: &SpecialRun, class: &ProbeClass, out: &mut impl Write) -> Written {
    writeln!(out, "\n## {}\n", class.title)?;
    write!(out, "| probe | computed | promised |")?;
    for adapter in &run.adapters {
        write!(out, " {} |", adapter.name)?;
    }
    writeln!(out, "\n|---|---|---|{}", "---|".repeat(run.adapters.len()))?;
    for probe in run.of_class(class) {
        write!(out, "| {} | {} | {} |", probe.name, probe.what, probe.promise)?;
        for adapter in &run.adapters {
            write!(out, " {} |", cell(run, probe, adapter))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn cell(run: &SpecialRun, probe: &ProbeRow, adapter: &Identity) -> String {
    let marked = |outcome: &ProbeResult| {
        let mark = match outcome.verdict.name() {
            "broken" => "✗ ",
            "deviates" => "! ",
            "changed" => "≠ ",
            _ => "",
        };
        format!("{mark}{}", outcome.value)
    };
    let mut words: Vec<String> = run.of(&probe.name, &adapter.name).map(marked).collect();
    words.dedup();
    if words.is_empty() { "–".into() } else { words.join(" / ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_document_makes_no_page() {
        for (json, message) in [
            ("{", "not JSON"),
            (r#"{"schema":"lightmeter.run/1"}"#, "expected lightmeter.special/1"),
            (r#"{"schema":"lightmeter.special/1","adapters":[],"outcomes":[]}"#, "nothing was probed"),
            (
                r#"{"schema":"lightmeter.special/1","adapters":[],"outcomes":[{"probe":"min-nan","adapter":"cpu","stage":"compute",
                    "bits":"0x00000000","value":"0","verdict":"indeterminate"}]}"#,
                "it does not name its rules",
            ),
        ] {
            let error = SpecialRun::read(json).expect_err("it is no page's");
            assert!(error.contains(message), "{error}");
        }
    }
}
