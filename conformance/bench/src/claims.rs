//! What the documents claim of cost and quality, held against what was measured.

use lightmeter_document::Number;
use lightmeter_document::bench::{BenchGroup, BenchRow, Claim, Errors, Rank};

/// A claim: its words, and the rows that it is about.
struct Claimed {
    id: &'static str,
    source: &'static str,
    claim: &'static str,
    group: &'static str,
    /// The row that the claim is about, and the one that it is held against.
    rows: [&'static str; 2],
    /// What the ratio of the first's time to the second's should be, where it is about time.
    time: Option<Rank>,
    /// What the first's error should be, where it is about that.
    quality: Option<Quality>,
    /// Which error goes with it.
    error: Figure,
}

/// An error that belongs to a claim.
#[derive(Clone, Copy)]
enum Figure {
    /// The first row's largest, on random inputs.
    Largest,
    /// The first row's mean, on random inputs.
    Mean,
    /// The second row's largest over the first's.
    TimesLarger,
}

/// What a claim says of the first row's error.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Quality {
    /// It is larger than the second's.
    Worse,
    /// The figure is below half a step of 8 bits: nobody sees it.
    Unseen,
}

const CLAIMS: [Claimed; 9] = [
    Claimed {
        id: "phong-costs-more",
        source: "000 §6.3",
        claim: "Lighting every fragment costs more than lighting the vertices",
        group: "technique/shading",
        rows: ["phong", "gouraud"],
        time: Some(Rank::Slower),
        quality: None,
        error: Figure::TimesLarger,
    },
    Claimed {
        id: "gouraud-interpolates",
        source: "004",
        claim: "Shading at each pixel is more accurate than interpolating the vertices' colours",
        group: "technique/shading",
        rows: ["gouraud", "phong"],
        time: None,
        quality: Some(Quality::Worse),
        error: Figure::Largest,
    },
    Claimed {
        id: "nonlocal-viewer",
        source: "000 §6.4",
        claim: "A viewer infinitely far away saves computing v, with similar results",
        group: "technique/viewer",
        rows: ["nonlocal", "local"],
        time: Some(Rank::Faster),
        quality: Some(Quality::Unseen),
        error: Figure::Mean,
    },
    Claimed {
        id: "blinn-avoids-r",
        source: "000 §6.4",
        claim: "Blinn's half vector avoids r and its normalisation",
        group: "technique/highlight",
        rows: ["blinn", "phong-normalised"],
        time: Some(Rank::Faster),
        quality: None,
        error: Figure::Mean,
    },
    Claimed {
        id: "blinn-against-reflect",
        source: "000 §6.4",
        claim: "Blinn's half vector is cheaper than r where r is not normalised again, as the documents' programs have it",
        group: "technique/highlight",
        rows: ["blinn", "phong"],
        time: Some(Rank::Faster),
        quality: None,
        error: Figure::Mean,
    },
    Claimed {
        id: "unit-light",
        source: "000 §6.4",
        claim: "A light's direction that is a unit vector need not be normalised",
        group: "technique/unit-light",
        rows: ["assumed-unit", "normalised"],
        time: Some(Rank::Faster),
        quality: None,
        error: Figure::Largest,
    },
    Claimed {
        id: "difference-equations",
        source: "004",
        claim: "Difference equations along a span are efficient",
        group: "technique/span-256",
        rows: ["differences", "direct"],
        time: Some(Rank::Faster),
        quality: None,
        error: Figure::Largest,
    },
    Claimed {
        id: "difference-equations-long",
        source: "004",
        claim: "Difference equations along a long span are efficient",
        group: "technique/span-4096",
        rows: ["differences", "direct"],
        time: Some(Rank::Faster),
        quality: None,
        error: Figure::Largest,
    },
    Claimed {
        id: "vectors-interpolated",
        source: "003",
        claim: "N, L and V may be computed at the vertices, interpolated, and normalised at the fragment",
        group: "technique/vectors",
        rows: ["interpolated", "computed"],
        time: None,
        quality: Some(Quality::Unseen),
        error: Figure::Largest,
    },
];

/// The claims whose rows were measured.
pub(super) fn claims(groups: &[BenchGroup]) -> Vec<Claim> {
    CLAIMS.iter().filter_map(|claimed| claim(claimed, groups.iter().find(|group| group.id == claimed.group)?)).collect()
}

fn claim(claimed: &Claimed, group: &BenchGroup) -> Option<Claim> {
    let row = |name: &str| group.rows.iter().find(|row| row.name == name);
    let [about, against] = [row(claimed.rows[0])?, row(claimed.rows[1])?];
    let (ratio, spread) = ratio(about, against)?;
    let [own, other] = [about.random.as_ref()?, against.random.as_ref()?];
    let (error, error_is) = figure(claimed.error, own, other);
    let verdict = super::turns::standing(spread);
    let in_time = claimed.time.map(|expected| (verdict != Rank::Tie).then_some(verdict == expected));
    let in_quality = claimed.quality.map(|quality| {
        Some(match quality {
            Quality::Worse => own.absolute.max.0 > other.absolute.max.0,
            Quality::Unseen => error < 0.5,
        })
    });
    let said: Vec<Option<bool>> = [in_time, in_quality].into_iter().flatten().collect();
    // It holds where all of it does, and does not where any of it does not.
    let holds =
        if said.contains(&Some(false)) { Some(false) } else { said.iter().all(Option::is_some).then_some(true) };
    let word = |holds| match holds {
        Some(true) => "holds",
        Some(false) => "does not hold",
        None => "is left open: a tie",
    };
    let judgements: Vec<String> = [("as to time", in_time), ("as to error", in_quality)]
        .into_iter()
        .filter_map(|(what, holds)| Some(format!("{what} it {}", word(holds?))))
        .collect();
    let sentence = format!(
        "{}: {} takes {ratio:.2} times as long as {} ({:.2} to {:.2}), and {error_is} is {}; {}.",
        claimed.claim,
        about.name,
        against.name,
        spread[0],
        spread[1],
        rounded(error),
        judgements.join(", "),
    );
    Some(Claim {
        id: claimed.id.into(),
        source: claimed.source.into(),
        claim: claimed.claim.into(),
        group: claimed.group.into(),
        rows: claimed.rows.map(str::to_owned),
        ratio,
        spread,
        error_is,
        error: Number(error),
        holds,
        sentence,
    })
}

/// The first row's time over the second's, both over the baseline's. Where neither is the baseline the spreads multiply.
fn ratio(about: &BenchRow, against: &BenchRow) -> Option<(f64, [f64; 2])> {
    let (a, b) = (about.time.as_ref()?, against.time.as_ref()?);
    Some((a.ratio / b.ratio, [a.spread[0] / b.spread[1], a.spread[1] / b.spread[0]]))
}

fn figure(figure: Figure, own: &Errors, other: &Errors) -> (f64, String) {
    match figure {
        Figure::Largest => (own.steps.max.0, "its largest error, in 1/255 of full scale,".into()),
        Figure::Mean => (own.steps.mean.0, "its mean error, in 1/255 of full scale,".into()),
        Figure::TimesLarger => {
            (other.absolute.max.0 / own.absolute.max.0, "the other's largest error, as a multiple of its own,".into())
        }
    }
}

/// Three figures.
fn rounded(x: f64) -> String {
    if x == 0.0 || (0.01..1e4).contains(&x.abs()) { format!("{x:.3}") } else { format!("{x:.2e}") }
}
