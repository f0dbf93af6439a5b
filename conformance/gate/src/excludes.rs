//! What a renderer leaves out of what it declares: by ids, or by what formulas and scenes are made of.

use super::error::ProcessError;
use super::frame::called;
use super::pack::made_by;
use super::words::clipped;
use lightmeter_catalogue::cases::ValueShape;
use lightmeter_catalogue::cases::blend::aliases;
use lightmeter_catalogue::filter::Filter;
use lightmeter_catalogue::nearest::did_you_mean;
use lightmeter_catalogue::select::{Member, catalogue};
use lightmeter_scene::depth::DepthTest;
use lightmeter_scene::effects::Effect;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;
use std::collections::{BTreeSet, HashSet};

/// By what an entry excludes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Key {
    /// The WGSL function of a formula.
    Function,
    /// The WGSL file of a formula's function.
    File,
    /// The shape of an input or an output.
    Shape,
    /// How matrices are laid out.
    Matrices,
    /// An equation or a factor of a blend state.
    Blend,
    /// A depth test's comparison, or whether it writes.
    Depth,
    /// An effect that a scene calls for.
    Effect,
    /// The format of a scene's target.
    Format,
}

impl Key {
    const ALL: [Self; 8] =
        [Self::Function, Self::File, Self::Shape, Self::Matrices, Self::Blend, Self::Depth, Self::Effect, Self::Format];

    const fn name(self) -> &'static str {
        match self {
            Self::Function => "function",
            Self::File => "file",
            Self::Shape => "shape",
            Self::Matrices => "matrices",
            Self::Blend => "blend",
            Self::Depth => "depth",
            Self::Effect => "effect",
            Self::Format => "format",
        }
    }

    /// What formulas have of it; nothing of what scenes have.
    fn of_formula(self, member: &Member) -> Vec<String> {
        let spec = &member.spec;
        let made_by = made_by(spec);
        match self {
            Self::Function => made_by.function.into_iter().collect(),
            Self::File => made_by.file.into_iter().collect(),
            Self::Matrices => made_by.matrices.iter().map(ToString::to_string).collect(),
            Self::Blend => {
                let states = made_by.blend.iter().flatten().flat_map(|layer| [layer.color, layer.alpha]);
                let names = states.flat_map(|state| [state.equation.name(), state.src.name(), state.dst.name()]);
                names.map(str::to_owned).collect()
            }
            Self::Depth => {
                let of_test = |test: DepthTest| [test.compare.name(), if test.write { "write" } else { "keep" }];
                made_by.depth.into_iter().flat_map(of_test).map(str::to_owned).collect()
            }
            Self::Shape => {
                let shapes =
                    spec.inputs.iter().map(|input| input.shape).chain(spec.outputs.iter().map(|one| one.shape));
                shapes.map(|shape: ValueShape| shape.name().to_owned()).collect()
            }
            Self::Effect | Self::Format => vec![],
        }
    }

    /// All that there is of it.
    fn all(self, members: &[Member]) -> BTreeSet<String> {
        match self {
            Self::Effect => Effect::ALL.iter().map(|effect| effect.name().to_owned()).collect(),
            Self::Format => TargetFormat::ALL.iter().map(|format| format.name().to_owned()).collect(),
            _ => members.iter().flat_map(|member| self.of_formula(member)).collect(),
        }
    }
}

/// What is left out.
#[derive(Debug, Default)]
pub(super) struct Excludes {
    ids: Option<Filter>,
    /// The formulas that an entry excludes by what they are made of.
    formulas: HashSet<String>,
    effects: Vec<String>,
    formats: Vec<String>,
}

impl Excludes {
    /// Reads the entries of a hello: globs of ids, or what formulas and scenes are made of, as `function:lighting_spot`, `file:fog.wgsl`,
    /// `shape:mat4`, `matrices:columns`, `blend:min`, `depth:less`, `effect:lightmap_nearest` and `format:rgba8unorm`.
    ///
    /// # Errors
    /// Where an entry cannot be read, or names what there is not. Whether globs match something is seen to elsewhere.
    pub(super) fn new(entries: &[String]) -> Result<Self, ProcessError> {
        let (by, globs): (Vec<&String>, Vec<&String>) = entries.iter().partition(|entry| entry.contains(':'));
        let mut excludes =
            Self { ids: (!globs.is_empty()).then(|| Filter::new(&globs)).transpose()?, ..Self::default() };
        if by.is_empty() {
            return Ok(excludes);
        }
        let members = catalogue();
        for entry in by {
            let (key, value) = read(entry, &members)?;
            match key {
                Key::Effect => excludes.effects.push(value.to_owned()),
                Key::Format => excludes.formats.push(value.to_owned()),
                _ => {
                    let has = |member: &&Member| key.of_formula(member).iter().any(|own| own == value);
                    excludes.formulas.extend(members.iter().filter(has).map(|member| member.spec.id.clone()));
                }
            }
        }
        let canonical: Vec<(String, String)> = aliases().collect();
        let also = canonical.into_iter().filter(|(_, of)| excludes.formulas.contains(of)).map(|(alias, _)| alias);
        let also: Vec<String> = also.collect();
        excludes.formulas.extend(also);
        Ok(excludes)
    }

    /// The entries that are globs of ids.
    pub(super) fn globs(entries: &[String]) -> impl Iterator<Item = &String> {
        entries.iter().filter(|entry| !entry.contains(':'))
    }

    /// Whether nothing is drawn on a format.
    pub(super) fn has_format(&self, format: TargetFormat) -> bool {
        self.formats.iter().any(|own| own == format.name())
    }

    /// Whether a formula or a scene is left out, as far as its id says.
    pub(super) fn has(&self, id: &str) -> bool {
        self.formulas.contains(id) || self.ids.as_ref().is_some_and(|ids| ids.selects(id))
    }

    /// Why a frame is left out; `None` where it is not.
    pub(super) fn of_frame(&self, frame: &Frame) -> Option<String> {
        if self.has_format(frame.target.format) {
            return Some(format!("it excludes {}", frame.target.format.name()));
        }
        let effects: Vec<&str> =
            called(frame).into_iter().filter(|name| self.effects.iter().any(|own| own == name)).collect();
        (!effects.is_empty()).then(|| format!("it excludes {}", effects.join(", ")))
    }
}

/// Names of one kind that an error lists, at most; of more it tells the nearest.
const MOST_LISTED: usize = 32;

/// The key of an entry and its value.
fn read<'a>(entry: &'a str, members: &[Member]) -> Result<(Key, &'a str), ProcessError> {
    let refused = |what, known| ProcessError::Excludes { entry: clipped(entry), what, known };
    let one_of =
        |names: &mut dyn Iterator<Item = &str>| format!("; expected one of {}", names.collect::<Vec<_>>().join(", "));
    let (name, value) = entry.split_once(':').unwrap_or_default();
    let Some(key) = Key::ALL.into_iter().find(|key| key.name() == name) else {
        return Err(refused("kind of thing", one_of(&mut Key::ALL.into_iter().map(Key::name))));
    };
    let all = key.all(members);
    if all.contains(value) {
        return Ok((key, value));
    }
    let mut names = all.iter().map(String::as_str);
    let known = if all.len() > MOST_LISTED {
        did_you_mean(value, names) + " `lightmeter list --formulas --format json` has those of each formula, `made_by`"
    } else {
        one_of(&mut names)
    };
    Err(refused(key.name(), known))
}
