//! The page on NaN, infinity, subnormals and signed zero, made from the JSON of `lightmeter special`.

use lightmeter_catalogue::special::{Class, DEVIATIONS, PROBES, Probe, Source};
use lightmeter_document::Document as _;
use lightmeter_document::run::Identity;
use lightmeter_document::special::{ProbeResult, SpecialReport};
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
    /// Where it is another document, interrupted, or of probes that this version does not have.
    pub fn read(json: &str) -> Result<Self, String> {
        let run = Self(SpecialReport::read(json).map_err(|error| error.to_string())?);
        if let Some(interrupted) = &run.interrupted {
            return Err(format!("it was interrupted: {interrupted}; expected one that is complete"));
        }
        let unknown = run.outcomes.iter().find(|outcome| Probe::by_name(&outcome.probe).is_none());
        match unknown {
            Some(outcome) => Err(format!("no probe `{}`: the file is of another version", outcome.probe)),
            None if run.outcomes.is_empty() => Err("nothing was probed".into()),
            None => Ok(run),
        }
    }

    /// Probes whose results differ between the stages of an adapter.
    fn by_stage(&self, adapter: &Identity) -> usize {
        let differs = |probe: &&Probe| {
            let mut values = self.of(probe.name, &adapter.name).map(|outcome| &outcome.value);
            let first = values.next();
            values.any(|value| Some(value) != first)
        };
        PROBES.iter().filter(differs).count()
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
    policy(out)?;
    drivers(run, out)?;
    for class in Class::ALL {
        table(run, class, out)?;
    }
    Ok(())
}

fn policy(out: &mut impl Write) -> Written {
    writeln!(out, "## What is promised\n")?;
    writeln!(out, "| section | says |\n|---|---|")?;
    for source in Source::ALL {
        writeln!(out, "| {} | {} |", source.section(), source.says())?;
    }
    let definite = PROBES.iter().filter(|probe| probe.promise.is_definite()).count();
    writeln!(
        out,
        "\nA *probe* is one operation on operands that are known at run time alone. Of {} probes {definite} are promised",
        PROBES.len()
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
    for deviation in DEVIATIONS {
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

fn table(run: &SpecialRun, class: Class, out: &mut impl Write) -> Written {
    writeln!(out, "\n## {}\n", class.title())?;
    write!(out, "| probe | computed | promised |")?;
    for adapter in &run.adapters {
        write!(out, " {} |", adapter.name)?;
    }
    writeln!(out, "\n|---|---|---|{}", "---|".repeat(run.adapters.len()))?;
    for probe in PROBES.iter().filter(|probe| probe.class == class) {
        let promise = probe.promise.words(probe.gives);
        write!(out, "| {} | {} | {promise} |", probe.name, probe.what)?;
        for adapter in &run.adapters {
            write!(out, " {} |", cell(run, probe, adapter))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn cell(run: &SpecialRun, probe: &Probe, adapter: &Identity) -> String {
    let marked = |outcome: &ProbeResult| {
        let mark = match outcome.verdict.name() {
            "broken" => "✗ ",
            "deviates" => "! ",
            "changed" => "≠ ",
            _ => "",
        };
        format!("{mark}{}", outcome.value)
    };
    let mut words: Vec<String> = run.of(probe.name, &adapter.name).map(marked).collect();
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
        ] {
            let error = SpecialRun::read(json).expect_err("it is no page's");
            assert!(error.contains(message), "{error}");
        }
    }
}
