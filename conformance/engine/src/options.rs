//! What a run is asked for.

use crate::device::Code;
use crate::subject::Subject;
use lightmeter_arithmetic::Profile;
use lightmeter_arithmetic::profile::PROFILES;
use lightmeter_catalogue::cases::Partial;
use lightmeter_catalogue::cases::blend::Samples;
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::scene::select::size;
use lightmeter_catalogue::select::{Held, Member, Shard};
use lightmeter_document::event::Stop;
use lightmeter_document::report::{BoundVariable, Failure, Report};
use lightmeter_judge::cases::ExpectedFailure;
use lightmeter_judge::diagnose::Diagnose;
use lightmeter_judge::formula::Judging;
use lightmeter_scene::target::TargetFormat;
use std::path::{Path, PathBuf};

/// One format of floats and one of 8 bits.
pub const DEFAULT_TARGETS: [TargetFormat; 2] = [TargetFormat::Rgba32Float, TargetFormat::Rgba8Unorm];
/// Random cases of each formula where no other number is asked for.
pub const DEFAULT_CASES: u64 = 4096;
/// Random cases for each formula of a renderer that is asked case by case, where nothing else is asked for.
pub const ASKED_CASES: u64 = 256;
/// The most cases of each formula that can be asked for.
pub const MOST_CASES: u64 = 1_000_000_000_000;

/// What to run.
#[derive(Clone)]
pub struct Options {
    /// Which cases.
    pub filter: Filter,
    /// Random cases for each formula.
    pub cases: u64,
    /// The seed.
    pub seed: u64,
    /// Which part.
    pub shard: Shard,
    /// The formats that are blended on.
    pub targets: Vec<TargetFormat>,
    /// Which states with another one for alpha are judged.
    pub samples: Samples,
    /// Pixels of the longer side of every scene; `None` for the scenes' own, or for a quarter of the pixels in a run of all.
    pub size: Option<u32>,
    /// Where the images of scenes that fail are written; `None` for nowhere.
    pub images: Option<PathBuf>,
    /// Whether what takes time is measured apart: the blend unit draws everything once more with its pipelines compiled, and
    /// stable forms are timed beside naive ones.
    pub again: bool,
    /// The accuracy rules.
    pub profile: &'static Profile,
    /// The code under test, for subjects on devices.
    pub code: Code,
    /// What to add to a command that runs one case again.
    pub rerun: String,
    /// The command that asks a renderer for a case, but for the case's id; nothing where its answers are in files.
    pub ask: Option<String>,
    /// Who is asked which mistake explains what fails; `None` for nobody.
    pub diagnose: Option<&'static dyn Diagnose>,
    /// Whether to stop.
    pub stop: Stop,
    /// Failures that are expected.
    pub expected: Vec<ExpectedFailure>,
    /// Whether the report says what became of each case, so that another run can be compared with it. Of renderers it always does.
    pub counts_cases: bool,
    /// Whether a shard's report has samples of its groups, by which the whole is diagnosed.
    pub samples_kept: bool,
    /// How often all is asked. An answer that changes is unstable.
    pub runs: u64,
    /// What the code under test gives of formulas, where that is not all.
    pub adapted: Vec<Adapted>,
}

/// How a formula is judged of code that was written for something a little different.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Adapted {
    /// The formula.
    pub id: String,
    /// The outputs that are not given, of which nothing is judged.
    pub missing: Vec<String>,
    /// Inputs that are constants there, and the same in all cases, or that are the same as another input.
    pub constants: Vec<(String, Constant)>,
    /// The code's variables, each with the expression over the inputs that it is set to.
    pub variables: Vec<BoundVariable>,
    /// The formula's inputs that no variable and no constant stands for.
    pub unbound: Vec<String>,
    /// The code's text, in which the lines of what is not judged are empty; all of it is empty where there is none.
    pub text: String,
}

/// What an input is that a shader has not.
#[derive(Clone, Debug, PartialEq)]
pub enum Constant {
    /// These numbers, in every case.
    Numbers(Vec<f32>),
    /// What another input is.
    SameAs(String),
}

impl Adapted {
    /// The formula as it is judged.
    #[must_use]
    pub fn applied(&self, member: Member) -> Member {
        let spec = &member.spec;
        let given = spec.outputs.iter().flat_map(|output| {
            std::iter::repeat_n(!self.missing.iter().any(|name| name == output.name), output.shape.components())
        });
        let given: Vec<bool> = given.collect();
        let place = |name: &str| spec.place(name).unwrap_or_default();
        let held = self.constants.iter().flat_map(|(name, constant)| -> Vec<(usize, Held)> {
            match constant {
                Constant::Numbers(values) => place(name).zip(values.iter().copied().map(Held::Number)).collect(),
                Constant::SameAs(other) => place(name).zip(place(other).map(Held::SameAs)).collect(),
            }
        });
        let held = held.collect();
        let missing: Vec<usize> =
            given.iter().enumerate().filter(|(_, given)| !**given).map(|(place, _)| place).collect();
        let formula =
            if missing.is_empty() { member.formula } else { Box::new(Partial { formula: member.formula, given }) };
        Member { held, formula, missing, number: member.number, spec: member.spec }
    }
}

impl Options {
    /// A formula as it is judged of the code under test.
    #[must_use]
    pub fn applied(&self, member: Member) -> Member {
        match self.adapted.iter().find(|adapted| adapted.id == member.spec.id) {
            Some(adapted) => adapted.applied(member),
            None => member,
        }
    }

    /// A report on these subjects, of nothing yet.
    #[must_use]
    pub fn report(&self, subjects: &[Subject]) -> Report {
        let filter = self.filter.globs().map(str::to_owned).collect();
        let adapters = subjects.iter().map(|subject| subject.identity.clone()).collect();
        Report {
            expectations: self.expected.iter().map(|expected| expected.known.clone()).collect(),
            ..Report::empty(self.seed, self.profile.name.into(), filter, adapters)
        }
    }

    /// Whose answers are judged, and by what.
    #[must_use]
    pub fn judging<'a>(&'a self, subject: &'a Subject) -> Judging<'a> {
        Judging {
            adapter: &subject.identity.name,
            known: &subject.known,
            profile: self.profile,
            seed: self.seed,
            expected: &self.expected,
            counts_cases: self.counts_cases || subject.asked().is_some(),
        }
    }

    /// Whether groups are reported with what a shard keeps of them.
    #[must_use]
    pub fn keeps_samples(&self) -> bool {
        self.samples_kept && self.shard != Shard::WHOLE
    }

    /// The command that judges a failing case once more; empty where there is none.
    #[must_use]
    pub fn again(&self, failure: &Failure, is_asked: bool) -> String {
        let Failure { id, adapter, .. } = failure;
        let target = failure.blended_on().map_or_else(String::new, |target| format!(" --target {target}"));
        if is_asked {
            return self.ask.as_ref().map_or_else(String::new, |ask| format!("{ask}{target} {id}"));
        }
        let size = size(&self.filter, self.size).filter(|_| id.starts_with("scene/"));
        let size = size.map_or_else(String::new, |size| format!(" --size {size}"));
        format!("lightmeter run '{id}' --adapter {adapter}{target}{size}{}", self.rerun)
    }

    /// A run of everything as it is without any option.
    #[must_use]
    pub fn new(code: Code) -> Self {
        Self {
            filter: Filter::default(),
            cases: DEFAULT_CASES,
            seed: 1,
            shard: Shard::WHOLE,
            targets: DEFAULT_TARGETS.to_vec(),
            samples: Samples::default(),
            size: None,
            images: None,
            again: false,
            profile: PROFILES[0],
            code,
            rerun: String::new(),
            ask: None,
            diagnose: None,
            stop: Stop::default(),
            expected: vec![],
            counts_cases: false,
            samples_kept: true,
            runs: 1,
            adapted: vec![],
        }
    }

    /// The same with a seed, a profile and the folder that the code is of, which a command that runs a case again is to name.
    #[must_use]
    pub fn by(code: Code, folder: Option<&Path>, seed: u64, profile: &'static Profile) -> Self {
        let mut rerun = String::new();
        if seed != 1 {
            rerun += &format!(" --seed {seed}");
        }
        if profile.name != PROFILES[0].name {
            rerun += &format!(" --profile {}", profile.name);
        }
        if let Some(dir) = folder {
            rerun += &format!(" --shaders '{}'", dir.display().to_string().replace('\'', r"'\''"));
        }
        Self { seed, samples: Samples { seed, ..Samples::default() }, profile, rerun, ..Self::new(code) }
    }
}
