//! How a target of 8 bits stores: told from many values together, each of which may be legal.
//!
//! A value between two steps speaks for every [`Store`] that would have given it. Values are judged by component, in each state
//! by itself and in all states of a group together, so that a fault of alpha alone or of one state's fast path is not
//! drowned in the rest.
//!
//! A unit that rounds its operands and products to 8 bits is legal, and in a single state its errors need not be like those of
//! one last rounding. Mesa's comes to 44 % nearest values and a mean distance of 0.14 steps from them at worst; on sRGB,
//! where a difference may fall where steps are fine, to 0.35 steps, and to 84 % values as a wrong store would have them. So a
//! state by itself fails where a wrong store is clear or the mean distance is near that of truncation; many states together,
//! where such errors cancel, where not most values are the nearest or the mean distance is an eighth of a step (Mesa's: 80 %
//! and 0.09 at worst).

use super::model::BlendUnitModel;
use super::pixel::step_below;
use super::rules::Store;
use crate::devices::Known;
use lightmeter_document::Word;
use lightmeter_document::report::{Problem, ProblemKind, SampledStores, SpecialUse, StoreUse, StoresOfState};
pub use lightmeter_document::sweep::StoreCounts;
use lightmeter_scene::target::{Encoding, TargetFormat};

/// References this near to a whole step are that step; those this near to the middle between two have no nearest.
pub const NEAR: f64 = 1e-3;

/// Values that must tell stores apart before they are judged: the share of one half then errs by some 3 %.
pub const ENOUGH: u64 = 256;
/// States from which on they are judged as many.
pub const MANY: usize = 16;
/// The least share of nearest values in many states.
const LEAST_NEAREST: f64 = 0.5;
/// The greatest mean distance in many states, in steps, and in a few: truncation has half a step.
const MOST_BIAS: f64 = 0.125;
const MOST_BIAS_OF_A_STATE: f64 = 0.4;
/// A store is named where this share of the values is as it would have them.
const CLEAR: f64 = 0.9;

/// What counted values say of how they are stored.
pub trait Stores {
    /// Counts a value. At whole steps and halfway between two stores cannot be told apart.
    fn count(&mut self, reference: f64, value: f64);

    /// The store that most values speak for, and their share; the first of equals, which is the right one.
    fn likeliest(&self) -> (Store, f64);

    /// What is wrong with how these values of `states` blend states are stored; `None` where nothing is, or where there are too few.
    fn problem(&self, states: usize) -> Option<String>;
}

/// What is wrong with how the components of values of `states` blend states are stored, by their names.
#[must_use]
pub fn problem_of(components: &[StoreCounts; 4], states: usize) -> Option<String> {
    let names = ["color.r", "color.g", "color.b", "color.a"];
    let found: Vec<(&str, String)> =
        names.into_iter().zip(components).filter_map(|(name, counts)| Some((name, counts.problem(states)?))).collect();
    let (_, first) = found.first()?;
    let wrong: Vec<&str> = found.iter().map(|(name, _)| *name).collect();
    Some(format!("{} {} {first}", wrong.join(", "), if found.len() > 1 { "are" } else { "is" }))
}

/// The model that a device is known to follow bit for bit on a target.
#[must_use]
pub fn declared_model(known: &Known, target: TargetFormat) -> Option<BlendUnitModel> {
    known.blend_model.filter(|_| target.encoding() == Encoding::Unorm8)
}

/// The group verdict on what a blend unit left: each value may be legal and the whole still wrong.
#[must_use]
pub fn problems<'a>(
    special: impl IntoIterator<Item = &'a SpecialUse>,
    stores: &SampledStores,
    known: &Known,
    target: TargetFormat,
) -> Vec<Problem> {
    let is_recorded = known.special_record.is_some_and(|(_, this_version)| this_version);
    if let Some(other) = special.into_iter().find(|special| is_recorded && !special.is_as_recorded()) {
        let recorded = other.recorded.as_deref().unwrap_or_default();
        let says = format!("{} gives {}, where {recorded} is on record for this driver", other.id, other.seen);
        return vec![Problem::new(ProblemKind::Special, says)];
    }
    let [of, others] = stores.model;
    if let Some(model) = declared_model(known, target)
        && others > 0
    {
        let first = stores.departure.as_deref().unwrap_or_default();
        let departs = format!("{others} of {of} values are not as {} has them, the first in {first}", model.name());
        return store_problem(stores).into_iter().chain([Problem::new(ProblemKind::Model, departs)]).collect();
    }
    if of > 0 { vec![] } else { store_problem(stores).into_iter().collect() }
}

/// What is wrong with how values are stored: of a component in all states, or of one in some.
fn store_problem(stores: &SampledStores) -> Option<Problem> {
    if let Some(problem) = problem_of(&stores.components, stores.states.len()) {
        let store = clear_store(&stores.components, stores.states.len());
        return Some(Problem { store, ..Problem::new(ProblemKind::Store, problem) });
    }
    let mut states = stores.states.iter().filter_map(|state| Some((state, problem_of(&state.components, 1)?)));
    let (StoresOfState { id, components, .. }, problem) = states.next()?;
    let others = states.count();
    let others = if others > 0 { format!(", and so in {others} other states") } else { String::new() };
    let told = Problem::new(ProblemKind::StoreOfState, format!("in {id} {problem}{others}"));
    Some(Problem { store: clear_store(components, 1), ..told })
}

/// The store of the first component that is stored wrongly, where it is clear.
fn clear_store(components: &[StoreCounts; 4], states: usize) -> Option<Word> {
    let (store, share) = components.iter().find(|counts| counts.problem(states).is_some())?.likeliest();
    (store != Store::Nearest && share >= CLEAR).then(|| store.name().into())
}

/// How values are stored: as the declared model has them, if all are, or as most values say.
#[must_use]
pub fn store_of(stores: &SampledStores, known: &Known, target: TargetFormat) -> Option<StoreUse> {
    let mut all = StoreCounts::default();
    stores.components.iter().for_each(|counts| all.add(counts));
    let [of, others] = stores.model;
    if let Some(model) = declared_model(known, target)
        && of > 0
        && others == 0
    {
        return Some(StoreUse { identified: model.name().into(), share: 1.0, of, bias: all.bias() });
    }
    let (store, share) = all.likeliest();
    (all.of >= ENOUGH).then(|| StoreUse { identified: store.name().into(), share, of: all.of, bias: all.bias() })
}

impl Stores for StoreCounts {
    fn count(&mut self, reference: f64, value: f64) {
        let fraction = reference - step_below(reference);
        if !(NEAR..=1.0 - NEAR).contains(&fraction) || (fraction - 0.5).abs() < NEAR {
            return;
        }
        self.of += 1;
        self.error += value - Store::Nearest.step(reference);
        for (count, store) in self.as_by.iter_mut().zip(Store::ALL) {
            *count += u64::from(store.step(reference).to_bits() == value.to_bits());
        }
    }

    fn likeliest(&self) -> (Store, f64) {
        let (place, share) = self.likeliest_place();
        (Store::ALL[place], share)
    }

    fn problem(&self, states: usize) -> Option<String> {
        if self.of < ENOUGH {
            return None;
        }
        let (store, share) = self.likeliest();
        let (nearest, bias) = (self.nearest(), self.bias());
        let is_clear = store != Store::Nearest && share >= CLEAR;
        let is_right = if states >= MANY {
            store == Store::Nearest && nearest > LEAST_NEAREST && bias.abs() < MOST_BIAS
        } else {
            !is_clear && bias.abs() < MOST_BIAS_OF_A_STATE
        };
        if is_right {
            return None;
        }
        let (of, percent) = (self.of, |share: f64| format!("{:.1} %", 100.0 * share));
        Some(if is_clear {
            format!(
                "stored {}: {} of {of} values are so, {} the nearest",
                store.name(),
                percent(share),
                percent(nearest)
            )
        } else {
            let nearest = percent(nearest);
            format!(
                "stored in no known way: {nearest} of {of} values are the nearest, on the mean they are {bias:+.2} steps from it"
            )
        })
    }
}
