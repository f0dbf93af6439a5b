//! A card of something that fails, and how much of it does.

use lightmeter_document::report::Group;
use maud::Markup;

/// What fails, told by itself.
pub(super) struct Card {
    /// Where links to it lead.
    pub(super) anchor: String,
    /// The formula or the scene.
    pub(super) name: String,
    /// Who computed it, and where.
    pub(super) place: String,
    /// The share of it that fails.
    pub(super) share: f64,
    /// The mistake, in words, where it is known.
    pub(super) cause: Option<String>,
    /// All that is known.
    pub(super) body: Markup,
}

/// Where the renderer's code of a group stands, behind a comma, where its hello says so.
pub(super) fn source_of(group: &Group) -> String {
    group.source.as_ref().map(|source| format!(", {source}")).unwrap_or_default()
}

/// How many failed that were not expected to, and of how many: verdicts, or whole cases where a renderer was asked. An image is one case,
/// and counts by its values.
pub(super) fn judged(group: &Group) -> (u64, u64) {
    let by_case = group.by_case.as_ref().filter(|_| group.image.is_none());
    by_case.map_or((group.totals.failed, group.totals.verdicts), |counts| {
        (counts.totals.failed.saturating_sub(counts.totals.expected_failures), counts.totals.asked)
    })
}

/// The share of groups' verdicts that fail or are missing, by which the worst comes first.
pub(super) fn failing_share(groups: &[&Group]) -> f64 {
    let unanswered =
        |group: &Group| group.by_case.as_ref().map_or(0, |counts| counts.totals.missing + counts.totals.undeclared);
    let count = |group: &Group| {
        let (failed, of) = judged(group);
        (failed + unanswered(group), of)
    };
    let (failed, verdicts) = groups.iter().map(|group| count(group)).fold((0, 0), |(f, v), (a, b)| (f + a, v + b));
    #[expect(clippy::cast_precision_loss, reason = "shares")]
    (failed as f64 / verdicts.max(1) as f64)
}

/// A share, in words.
pub(super) fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "as a whole".into(),
        least if least < 0.1 => "below 0.1 %".into(),
        small if small < 10.0 => format!("{small:.1} %"),
        great => format!("{great:.0} %"),
    }
}
