//! The process that makes a shader the function of formulas: it alone reads what somebody wrote, so that it alone can be ended where that takes too long.

use super::shader::{BOUND, JUDGED, OwnShader, is_identified};
use super::{Status, foreign};
use anyhow::{Context as _, anyhow, bail};
use clap::Args;
use lightmeter::cases::Spec;
use lightmeter::document::report::FoundBy;
use lightmeter::document::report::JudgedAs;
use lightmeter::select::catalogue;
use lightmeter_adapt::bind::{Bound, ShaderBinding, bind};
use lightmeter_adapt::{AdaptError, MOST_TURNS, Part, ShaderProgram, replaced};
use lightmeter_gpu::Shaders;
use lightmeter_shaders::read::ShaderSource;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Make a shader the function of formulas
#[derive(Debug, Args)]
pub(crate) struct Adapt {
    /// Where the WGSL is written
    folder: PathBuf,
    /// The formulas
    formulas: Vec<String>,
    /// Every formula that it can be bound to, in place of them
    #[arg(long)]
    every: bool,
    #[command(flatten)]
    own: OwnShader,
}

impl Adapt {
    /// Writes the files, and tells what is bound.
    pub(crate) fn run(self) -> anyhow::Result<Status> {
        foreign::limit_time();
        let (part, file) = self.own.part()?;
        let source = ShaderSource::read(&file)?;
        let program = ShaderProgram::new(&file, &source, &part)?;
        let catalogue = catalogue();
        let asked = self.own.asked()?;
        let bound: Vec<(&Spec, ShaderBinding)> = if self.every {
            let own = catalogue.iter().map(|member| &member.spec).filter(|spec| is_identified(spec));
            let own = self.own.with_constants(own)?;
            let (bound, others): (Vec<_>, Vec<_>) =
                own.into_iter().map(|spec| Ok((spec, bind(&program, spec, &asked)?))).partition(Result::is_ok);
            // What has no input in it would be judged as anything.
            let has_input = |found: &Result<(&Spec, ShaderBinding), AdaptError>| {
                found.as_ref().is_ok_and(|(_, binding)| binding.bound.iter().any(|bound| bound.found != FoundBy::Fixed))
            };
            if !bound.is_empty() && !bound.iter().any(has_input) {
                bail!(
                    "no variable of {} stands for an input of a formula: its result is always the same",
                    file.display()
                );
            }
            let bound: Vec<_> = bound.into_iter().filter(has_input).collect();
            if bound.is_empty() {
                let refused = others.into_iter().filter_map(|other: Result<_, AdaptError>| other.err());
                return Err(no_formula(&file, refused));
            }
            bound.into_iter().flatten().collect()
        } else {
            let of = |id: &String| -> anyhow::Result<(&Spec, ShaderBinding)> {
                let member = catalogue.iter().find(|member| member.spec.id == *id);
                let member = member.with_context(|| format!("no formula `{id}`"))?;
                Ok((&member.spec, bind(&program, &member.spec, &asked)?))
            };
            let (bound, mut others): (Vec<_>, Vec<_>) = self.formulas.iter().map(of).partition(Result::is_ok);
            // Of several formulas it is judged by those that its variables fit.
            if let (true, Some(Err(error))) = (bound.is_empty(), others.pop()) {
                return Err(error);
            }
            bound.into_iter().flatten().collect()
        };
        for (name, text) in replaced(&Shaders::built_in()?, &program, &bound)? {
            std::fs::write(self.folder.join(&name), text)?;
        }
        let judged: Vec<JudgedAs> = bound.iter().map(|(spec, binding)| self.own.judged_as(spec, binding)).collect();
        std::fs::write(self.folder.join(BOUND), serde_json::to_string(&judged)?)?;
        std::fs::write(self.folder.join(JUDGED), &program.text)?;
        let mut told = String::new();
        for (spec, binding) in &bound {
            tell((&file, &part), &self.own, (spec, binding), &mut told)?;
        }
        super::show(&told, None)?;
        Ok(Status::Success)
    }
}

/// That a shader can be bound to no formula: with what is not known of the nearest one, the first that knows the most of its variables.
fn no_formula(file: &Path, refused: impl Iterator<Item = AdaptError>) -> anyhow::Error {
    let unknown = |error: &AdaptError| match error {
        AdaptError::Unknown { variables, .. } => *variables,
        AdaptError::Expression(_) => usize::MAX,
        _ => 0,
    };
    let nearest = refused.min_by_key(unknown).map(|error| error.to_string());
    anyhow!(
        "the variables of {} can be bound to the inputs of no formula. Nearest is this: {}",
        file.display(),
        nearest.unwrap_or_default()
    )
}

/// An expression as people read it.
fn shortened(expression: &str) -> String {
    match expression {
        // A matrix of another size, by its columns.
        resized if resized.starts_with("mat") && resized.contains(")[0]") => {
            let name = resized.split_once(")[0]").and_then(|(before, _)| before.rsplit_once('('));
            name.map_or(resized, |(_, name)| name).to_owned()
        }
        matrix if matrix.starts_with("mat") => "the identity".into(),
        zero if zero.ends_with("()") => "0".into(),
        other => other.to_owned(),
    }
}

/// When a shader gives no value.
fn tell_without_value(binding: &ShaderBinding, out: &mut String) -> std::fmt::Result {
    if binding.discards {
        writeln!(
            out,
            "  It discards fragments. A case fails where its fragment is discarded: its value is reported as NaN."
        )?;
    }
    if binding.loops {
        writeln!(
            out,
            "  It has loops. A case fails where they turn more than {} times in all: its value is reported as NaN.",
            lightmeter::document::thousands(u64::from(MOST_TURNS))
        )?;
    }
    Ok(())
}

/// What is judged, and what each of its variables stands for.
fn tell(
    (file, part): (&Path, &Part),
    own: &OwnShader,
    (spec, binding): (&Spec, &ShaderBinding),
    out: &mut String,
) -> std::fmt::Result {
    let what = match part {
        Part::Shader => file.display().to_string(),
        Part::Function(name) => format!("`{name}` of {}", file.display()),
    };
    writeln!(out, "{what} is judged as {}. What its variables are taken to be:", spec.id)?;
    let width = binding
        .bound
        .iter()
        .filter(|bound| !bound.is_further)
        .map(|bound| bound.name.chars().count())
        .max()
        .unwrap_or(0);
    for bound in binding.bound.iter().filter(|bound| !bound.is_further) {
        let found = match bound.found {
            FoundBy::Asked => "  (as you say)",
            FoundBy::Fixed => "  (given by the pipeline, or not used)",
            FoundBy::SameName | FoundBy::Synonym => "",
        };
        writeln!(out, "  {:width$}  {}{found}", bound.name, shortened(&bound.expression))?;
    }
    if binding.bound.iter().any(|bound| bound.is_further) {
        writeln!(out, "  The further lights of its arrays are black.")?;
    }
    for bound in &binding.bound {
        if let Some(turned) = &bound.turned {
            writeln!(out, "  If {} points the other way: --bind '{}={turned}'", bound.name, bound.name)?;
        }
    }
    for (name, value) in &binding.outputs {
        if value.is_none() {
            writeln!(out, "  The shader does not give {name}, which is not judged.")?;
        }
    }
    for (name, other, is) in alike(binding) {
        writeln!(out, "  Both {name} and {other} are taken to be {is}. If one is not: --bind '{other}=…'")?;
    }
    tell_without_value(binding, out)?;
    let unused: Vec<&str> = own.unbound(binding).collect();
    if !unused.is_empty() {
        writeln!(
            out,
            "  Nothing in it stands for {}. What it has as a constant, or in common with another input, is said by `--constant {}=VALUE`, \
             where VALUE is numbers or an input's name.",
            unused.join(", "),
            unused[0]
        )?;
    }
    Ok(())
}

/// Variables that are taken to be the same input, which may be more than is meant.
fn alike(binding: &ShaderBinding) -> Vec<(&str, &str, &str)> {
    let told = |bound: &&Bound| matches!(bound.found, FoundBy::SameName | FoundBy::Synonym) && !bound.is_further;
    let told: Vec<&Bound> = binding.bound.iter().filter(told).collect();
    let mut found = vec![];
    for (k, one) in told.iter().enumerate() {
        let other = told[k + 1..].iter().find(|other| other.expression == one.expression);
        // Matrices, and lights that are left out, have no input in them.
        let has_input = !one.expression.ends_with("()") && !one.expression.contains("mat");
        found.extend(
            other.filter(|_| has_input).map(|other| (one.name.as_str(), other.name.as_str(), one.expression.as_str())),
        );
    }
    found
}
