//! What is judged in one go: a table of special values, the formulas of a group, a scene.

use crate::selection::Selection;
use crate::special::verdict::Table;
use crate::subject::Subject;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::scene;
use lightmeter_catalogue::scene::Loaded;
use lightmeter_catalogue::scene::select::Chosen;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_document::by_case::CaseCounts;
use lightmeter_document::run::{Group, Totals};

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

    /// When it is judged. Scenes, which have no scouts, come soon; blend states, whose pipelines take a driver's compiler longest, last.
    pub(crate) fn rank(self, catalogue: &[Member]) -> usize {
        match self {
            Self::Table(_) => 0,
            Self::Scene(_) => 1,
            Self::Formulas(group) if matches!(catalogue[group[0].member].spec.kind, Kind::Blend(_)) => 3,
            Self::Formulas(_) | Self::Blended(_) => 2,
        }
    }
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
        by_case: Some(CaseCounts { not_asked: cases, reason: Some(reason), ..CaseCounts::default() }),
        ..Group::new(id, subject.identity.name.clone(), stage)
    }
}

/// The cases of a group, each with its formula's place in it.
pub(crate) fn cases_of(group: &[Selected]) -> impl Iterator<Item = (usize, CaseRef)> + '_ {
    group.iter().enumerate().flat_map(|(of, chosen)| chosen.cases().map(move |case| (of, case)))
}
