//! What is judged in one go: a table of special values, the formulas of a group, a scene.

use crate::selection::Selection;
use crate::special::verdict::Table;
use crate::subject::Subject;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::scene;
use lightmeter_catalogue::scene::Loaded;
use lightmeter_catalogue::scene::select::Chosen;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_document::by_case::{CaseCounts, CaseTotals};
use lightmeter_document::report::{Group, Totals};

/// Cases of a chunk.
pub(crate) const CHUNK: usize = 1 << 14;
/// What is judged in one go.
#[derive(Clone, Copy)]
pub(crate) enum Turn<'a> {
    Table(&'a Table),
    /// The formulas of a group.
    Formulas(&'a [Selected]),
    /// Blend states of a group, of which a renderer is asked on targets.
    Blended(&'a [Selected]),
    Scene(&'a Chosen),
}

impl Turn<'_> {
    pub(crate) fn id(self, selection: &Selection) -> String {
        let (catalogue, is_by_formula) = (&selection.catalogue, selection.is_by_formula);
        match self {
            Self::Table(table) => table.id(),
            Self::Formulas(group) if is_by_formula => catalogue[group[0].member].spec.id.clone(),
            Self::Formulas(group) | Self::Blended(group) => catalogue[group[0].member].spec.group().to_owned(),
            Self::Scene(chosen) => scene::select::scene_id(chosen.place),
        }
    }

    /// When it is judged. Scenes, which have no scouts, come soon, and with them what rasterisers and depth tests draw; blend states, whose pipelines
    /// take a driver's compiler longest, last.
    fn rank(self, catalogue: &[Member]) -> usize {
        match self {
            Self::Table(_) => 0,
            Self::Scene(_) => 1,
            Self::Blended(_) => 2,
            Self::Formulas(group) => match catalogue[group[0].member].spec.kind {
                Kind::Raster(_) | Kind::Depth(_) => 1,
                Kind::Arithmetic => 2,
                Kind::Blend(_) => 3,
            },
        }
    }
}

/// Puts turns into the order in which they are judged by devices. Scenes and what rasterisers draw are spread among one another: of scenes
/// working out what is legal takes most of the time, of rasterisers' cases drawing them, and a device is handed what comes next ahead.
pub(crate) fn in_order_of_devices(turns: &mut Vec<(usize, Turn<'_>)>, catalogue: &[Member]) {
    turns.sort_by_key(|(_, turn)| turn.rank(catalogue));
    let soon: Vec<_> = turns.extract_if(.., |(_, turn)| turn.rank(catalogue) == 1).collect();
    let (scenes, drawn): (Vec<_>, Vec<_>) = soon.into_iter().partition(|(_, turn)| matches!(turn, Turn::Scene(_)));
    let first = turns.partition_point(|(_, turn)| turn.rank(catalogue) < 1);
    // The k-th of n stands at (2k + 1)/2n of the whole.
    let place = |k: usize, others: usize| (2 * k + 1) * others;
    let (of_scenes, of_drawn) = (scenes.len(), drawn.len());
    let scenes = scenes.into_iter().enumerate().map(|(k, turn)| (place(k, of_drawn), turn));
    let drawn = drawn.into_iter().enumerate().map(|(k, turn)| (place(k, of_scenes), turn));
    let mut spread: Vec<_> = scenes.chain(drawn).collect();
    spread.sort_by_key(|(place, _)| *place);
    turns.splice(first..first, spread.into_iter().map(|(_, turn)| turn));
}

/// All that a selection judges, in the order of reports.
pub(crate) fn turns(selection: &Selection) -> Vec<Turn<'_>> {
    // First: Mesa 22.3's lavapipe no longer flushes subnormals in fragments once it has drawn certain scenes.
    let tables = selection.tables.iter().map(Turn::Table);
    let formulas = selection.groups().map(Turn::Formulas);
    let blended = selection.blended_groups().map(Turn::Blended);
    tables.chain(formulas).chain(blended).chain(selection.scenes.iter().map(Turn::Scene)).collect()
}

/// A chosen scene, in the size that the selection draws it in.
pub(crate) fn scene_of(chosen: &Chosen, selection: &Selection) -> Loaded {
    scene::select::builtin(chosen.place, selection.size).expect("a test loads every scene that is built in")
}

/// The group of what a renderer does not declare.
pub(crate) fn not_asked(id: String, stage: &'static str, cases: u64, reason: String, subject: &Subject) -> Group {
    Group {
        totals: Totals { cases, skipped: cases, ..Totals::default() },
        skip_reason: Some(reason.clone().into()),
        by_case: Some(CaseCounts {
            totals: CaseTotals { not_asked: cases, ..CaseTotals::default() },
            reason: Some(reason),
            ..CaseCounts::default()
        }),
        ..Group::new(id, subject.identity.name.clone(), stage)
    }
}

/// The cases of a group, each with its formula's place in it.
pub(crate) fn cases_of(group: &[Selected]) -> impl Iterator<Item = (usize, CaseRef)> + '_ {
    group.iter().enumerate().flat_map(|(of, chosen)| chosen.cases().map(move |case| (of, case)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Code;
    use crate::options::Options;

    #[test]
    fn scenes_and_what_rasterisers_draw_are_spread_among_one_another() {
        let selection = Selection::of(&Options::new(Code::default()));
        let mut turns: Vec<(usize, Turn<'_>)> = turns(&selection).into_iter().enumerate().collect();
        let count = turns.len();
        in_order_of_devices(&mut turns, &selection.catalogue);
        let ranks: Vec<usize> = turns.iter().map(|(_, turn)| turn.rank(&selection.catalogue)).collect();
        assert!(ranks.is_sorted());
        let mut places: Vec<usize> = turns.iter().map(|(place, _)| *place).collect();
        places.sort_unstable();
        assert!(places.into_iter().eq(0..count));
        let is_scene: Vec<bool> = (turns.iter().zip(&ranks))
            .filter(|(_, rank)| **rank == 1)
            .map(|((_, turn), _)| matches!(turn, Turn::Scene(_)))
            .collect();
        let (half, scenes) = (is_scene.len() / 2, is_scene.iter().filter(|is_scene| **is_scene).count());
        assert!(scenes == selection.scenes.len() && scenes < is_scene.len());
        let soon = is_scene[..half].iter().filter(|is_scene| **is_scene).count();
        assert!((scenes / 2).abs_diff(soon) <= 1, "{soon} of {scenes} scenes in the first half");
    }
}
