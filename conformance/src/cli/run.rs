//! `lightmeter run`.

use super::clock::now;
use super::comparison::{Comparison, Earlier, matches_something};
use super::config::used;
use super::options::{AlsoJson, Amount, Choice, ReportFormat, Required};
use super::progress::{Bar, Stream};
use super::result::{status, written};
use super::say;
use super::shader::hash_of;
use super::signals::stopped_by_signals;
use super::terminal::level;
use super::{Status, abandon, command, writable};
use clap::Args;
use lightmeter::arithmetic::Profile;
use lightmeter::browser::Session;
use lightmeter::cases::GENERATOR_VERSION;
use lightmeter::cases::blend::{Samples, separate_of, written_state};
use lightmeter::document::Document as _;
use lightmeter::document::by_case::ComparedBy;
use lightmeter::document::event::Stop;
use lightmeter::document::pack::Choice as CaseChoice;
use lightmeter::document::report::{Identity, Report, Sentence};
use lightmeter::document::thousands;
use lightmeter::faults::{Mistakes, explain};
use lightmeter::filter::Filter;
use lightmeter::gate::baseline::{Standard, Subjects};
use lightmeter::gate::expectations::Expectations;
use lightmeter::judge::cases::ExpectedFailure;
use lightmeter::nearest::did_you_mean;
use lightmeter::options::Options;
use lightmeter::report::{html, text};
use lightmeter::run::run;
use lightmeter::scene::library::SCENES;
use lightmeter::scene::select::scene_id;
use lightmeter::select::{catalogue_of, select};
use lightmeter::subject::Subject;
use lightmeter::witness::NamedDeviation;
use std::path::PathBuf;
use std::sync::Arc;

/// Judge the wgpu implementation on an adapter.
#[derive(Clone, Debug, Args)]
pub(crate) struct Run {
    /// Globs that match an id or an ancestor of it: `fog`, `fog/*/hard`, `blend/add/**/0007`
    filter: Vec<String>,
    /// A blend or depth state as OpenGL, WebGL, WebGPU or Vulkan writes it, as `glBlendFunc(GL_SRC_ALPHA, GL_ONE)`; again for several
    #[arg(long, value_name = "STATE", value_parser = state)]
    blend: Vec<String>,
    #[command(flatten)]
    choice: Choice,
    #[command(flatten)]
    amount: Amount,
    /// With a shader that fails: print the stable form of the formula, in the shader's language
    #[arg(long)]
    suggest: bool,
    /// A row for each formula rather than for each family
    #[arg(long)]
    groups: bool,
    /// Say where the time went; the blend unit draws everything twice, to tell what its first drawing costs
    #[arg(long)]
    timing: bool,
    /// States with another one for alpha, drawn from all 1,265,625 and judged besides those that cover every pair
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u64).range(0..=1_265_625))]
    separate: u64,
    /// Where reference, result and error map of a scene that fails are written
    #[arg(long, value_name = "DIR", default_value = "lightmeter-failures")]
    images: PathBuf,
    /// How many times to ask everything; a result that changes is unstable
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=1000))]
    runs: u64,
    /// End with the first formula, state or scene that fails
    #[arg(long)]
    fail_fast: bool,
    #[command(flatten)]
    comparison: Comparison,
    /// Of a shard: leave the samples out by which `merge` tells what explains failures
    #[arg(long, requires = "shard")]
    no_samples: bool,
    #[command(flatten)]
    required: Required,
    /// How the result is written
    #[arg(long, value_enum, default_value = "text")]
    format: ReportFormat,
    /// Write the result to a file
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    also_json: AlsoJson,
}

/// What is asked for, checked.
pub(crate) struct Prepared {
    expectations: Expectations,
    earlier: Option<Earlier>,
    options: Options,
    compared_by: ComparedBy,
    is_shard: bool,
}

impl Prepared {
    /// What ends the run before its time.
    pub(crate) const fn stop(&self) -> &Stop {
        &self.options.stop
    }
}

impl Run {
    /// The adapters that were named.
    pub(crate) fn adapters(&self) -> &[String] {
        self.choice.adapters()
    }

    /// The accuracy rules.
    pub(crate) const fn profile(&self) -> &'static Profile {
        self.choice.profile
    }

    /// The same, whose result does not overwrite that of the runs before.
    pub(crate) fn numbered(mut self, number: usize) -> Self {
        for out in self.out.iter_mut().chain(self.also_json.file()).filter(|_| number > 1) {
            let stem = out.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let ending = out.extension().map(|ending| format!(".{}", ending.to_string_lossy())).unwrap_or_default();
            out.set_file_name(format!("{stem}-{number}{ending}"));
        }
        self
    }

    pub(crate) fn run(mut self) -> anyhow::Result<Status> {
        let prepared = self.prepared()?;
        let subjects = self.choice.subjects()?;
        self.judged(prepared, subjects, None)
    }

    /// What is asked for, checked, before anything is opened.
    pub(crate) fn prepared(&mut self) -> anyhow::Result<Prepared> {
        self.filter.append(&mut self.blend);
        if self.suggest {
            self.choice.shaders.own.part()?;
        }
        let expectations = self.comparison.expectations()?;
        let earlier = self.comparison.earlier(false)?;
        matches_something(&expectations)?;
        let shard = self.amount.shard.0;
        let named = self.filter.iter().filter_map(|glob| separate_of(glob)).collect();
        let samples = Samples { seed: self.choice.seed, count: self.separate, named };
        let filter = matching(&self.filter, self.amount.cases, &samples, self.choice.size)?;
        let mut options = self.choice.options(filter, self.amount.cases, shard)?;
        options.images = Some(self.images.clone());
        options.again = self.timing;
        options.samples = samples;
        options.diagnose = Some(&Mistakes);
        options.stop = stopped_by_signals()?;
        options.runs = self.runs;
        options.counts_cases = true;
        options.samples_kept = !self.no_samples;
        writable(self.out.as_deref())?;
        let [expect, baseline] = self.comparison.files();
        self.also_json.is_writable([("out", self.out.as_deref()), ("expect", expect), ("baseline", baseline)])?;
        let compared_by = self.compared_by(&options);
        if let Some(Earlier { baseline, path, .. }) = &earlier {
            baseline.is_of(
                &compared_by.choice,
                (std::iter::empty(), false),
                Some(&options.profile.name.into()),
                path,
            )?;
        }
        Ok(Prepared { expectations, earlier, options, compared_by, is_shard: shard.count.get() > 1 })
    }

    /// Runs what is asked for on subjects, and tells the result; a browser's page too, where that is judged.
    pub(crate) fn judged(
        &self,
        prepared: Prepared,
        mut subjects: Vec<Subject>,
        session: Option<Arc<Session>>,
    ) -> anyhow::Result<Status> {
        let Prepared { expectations, earlier, mut options, compared_by, is_shard } = prepared;
        if let Some(earlier) = &earlier {
            let names = subjects.iter().map(|subject| subject.identity.name.to_string());
            earlier.is_by(&Subjects::Adapters(names.collect()))?;
        }
        options.expected = known_failures(&expectations, &subjects);
        let stream = if self.is_read_by_people() { Stream::Output } else { Stream::Error };
        let fail_fast = self.fail_fast.then(|| options.stop.clone());
        let mut bar = Bar::new(None, "cases").live(stream).fail_fast(fail_fast).shown_to(session.clone());
        let report = run(&mut subjects, &options, &mut bar);
        bar.bar.finish_and_clear();
        let report = match report {
            // Closing a device that hangs would hang as well.
            Err(error) if error.is_of_device() => {
                abandon(subjects);
                return Err(error.into());
            }
            report => report?,
        };
        let shader = self.choice.shaders.own.used(&options.adapted, &report);
        let command = Some(command());
        let required = Some(self.required.part());
        let mut report = Report {
            compared_by: Some(compared_by),
            config: used(),
            made_at: now(),
            shader,
            command,
            required,
            ..report
        };
        report.shaders_hash = hash_of(&options.code)?;
        let named: Vec<_> = report.adapters.iter().map(|adapter| (&*adapter.name, &*adapter.driver)).collect();
        let others = expectations.of_others(&named);
        report.notes.extend(others.map(Sentence::from));
        // Of shards, `merge` works it out.
        report.explained = if is_shard { vec![] } else { explain(&report, options.profile) };
        // What was not judged for want of time is no regression.
        let whole = earlier.as_ref().filter(|_| report.interrupted.is_none());
        let regressions = whole.map(|earlier| earlier.compare(&Standard::from(&report), is_shard)).transpose();
        report.regressions = regressions.as_ref().map_or(vec![], |found| found.clone().unwrap_or_default());
        (report.mended, report.added) =
            whole.map(|earlier| earlier.progress(&Standard::from(&report))).unwrap_or_default();
        if let Some(session) = &session {
            session.tell_the_end(said_of(&report), Some([html::of_report(&report), report.to_json()?]));
        }
        let emitted = self.format.emit(&self.write(&report)?, self.out.as_deref());
        let kept = self.also_json.emit(|| report.to_json());
        if self.suggest {
            say(self.choice.shaders.own.suggested(&options.adapted, &report)?.trim_end());
        }
        if report.interrupted.is_some() {
            abandon(subjects);
        }
        regressions?;
        self.comparison.update(&report)?;
        emitted.and(kept)?;
        Ok(status(&report, self.required))
    }

    /// What chooses the cases, by which a later run is compared with this one.
    fn compared_by(&self, options: &Options) -> ComparedBy {
        let Choice { seed, size, .. } = self.choice;
        let (filter, held) = (self.filter.clone(), self.choice.shaders.own.held());
        ComparedBy {
            choice: CaseChoice { filter, cases: self.amount.cases, seed, size, held, ..CaseChoice::default() },
            generator: GENERATOR_VERSION,
            targets: options.targets.iter().map(|target| target.name().into()).collect(),
            declared: vec![],
            separate: Some(self.separate),
            shard: (options.shard.count.get() > 1).then(|| self.amount.shard.to_string()),
        }
    }

    /// Whether the result is text on standard output.
    fn is_read_by_people(&self) -> bool {
        self.format == ReportFormat::Text && self.out.is_none()
    }

    fn write(&self, report: &Report) -> anyhow::Result<String> {
        let detail = if self.groups { text::Detail::Groups } else { text::Detail::Families };
        let style = text::Style { detail, timing: self.timing, is_told: self.is_read_by_people(), level: level() };
        written(report, self.format, style)
    }
}

/// What a browser's page is told at the end.
fn said_of(report: &Report) -> String {
    let totals = &report.totals;
    let counts = format!("{} verdicts, {} failed", thousands(totals.verdicts), thousands(totals.failed));
    match &report.interrupted {
        Some(interrupted) => format!("The run ended before its time: {}. {counts}.", interrupted.message),
        None if report.is_success() => format!("This GPU computes all of it right: {counts}."),
        None => format!("This GPU computes something wrong, or the shaders do: {counts}. The report says what."),
    }
}

/// The id of a state as somebody writes it.
fn state(text: &str) -> Result<String, String> {
    let expected = "expected such as `glBlendFunc(GL_SRC_ALPHA, GL_ONE)`, or a descriptor of WebGPU or Vulkan as JSON";
    written_state(text).unwrap_or_else(|| Err(expected.into()))
}

/// The known failures of the adapters, each by its name and the version of its driver.
fn known_failures(expectations: &Expectations, subjects: &[Subject]) -> Vec<ExpectedFailure> {
    let mut known: Vec<ExpectedFailure> = vec![];
    for Identity { name, driver, .. } in subjects.iter().map(|subject| &subject.identity) {
        for one in expectations.of(name, driver) {
            if !known.iter().any(|other| other.known.id == one.known.id && other.known.reason == one.known.reason) {
                known.push(one);
            }
        }
    }
    known
}

/// The filter, each of whose globs must match something.
pub(crate) fn matching(globs: &[String], cases: u64, samples: &Samples, size: Option<u32>) -> anyhow::Result<Filter> {
    let catalogue = catalogue_of(samples);
    for glob in globs {
        let filter = Filter::new(std::slice::from_ref(glob))?;
        let whole = lightmeter::select::Shard::WHOLE;
        let scenes = lightmeter::scene::select::select(&filter, whole, size);
        let tables = lightmeter::special::verdict::select(&filter, whole);
        let others = scenes.is_empty() && tables.is_empty() && NamedDeviation::named(&filter).is_empty();
        if others && select(&catalogue, &filter, cases, whole).is_empty() {
            let families = lightmeter::cases::FAMILIES.join(", ") + ", special, scene, deviation";
            let ids = catalogue.iter().map(|member| member.spec.id.clone());
            let scenes = (0..SCENES.len()).map(scene_id);
            let own = lightmeter::cases::FAMILIES.iter().map(ToString::to_string);
            let names: Vec<String> = ids.chain(scenes).chain(own).collect();
            let meant = did_you_mean(glob, names.iter().map(String::as_str));
            anyhow::bail!(
                "no case matches `{glob}`{meant} Ids begin with a family ({families}), as `fog/linear/random/000017`: see \
                 `lightmeter list`"
            );
        }
    }
    Ok(Filter::new(globs)?)
}
