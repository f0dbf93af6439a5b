//! The ways in which one pixel may come about.
//!
//! Where coverage is open, one triangle of those that meet at the pixel covers it, if their shared edges leave no other way;
//! elsewhere each may or may not. Where the winner of a depth test is open, or a condition of the shading is, both outcomes
//! are followed. Each way gives an interval of its own; what is legal is the hull of all.

use super::prepared::Prepared;
use crate::blend_unit::expect::over;
use crate::blend_unit::pixel::Units;
use lightmeter_arithmetic::{Accept, paths};
use lightmeter_reference::Rgba;
use lightmeter_reference::render::Scratch;
use lightmeter_scene::depth::Compare;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::stage::Intermediate;
use lightmeter_scene::target::TargetFormat;
use smallvec::{SmallVec, smallvec};
use std::ops::Range;

/// Ways that are followed for one pixel; beyond, anything is legal there.
const MOST: usize = 64;

/// What a pixel may hold, in the units of its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegalPixel {
    /// The least legal value of each component.
    pub low: Units,
    /// The greatest.
    pub high: Units,
    /// Whether its coverage, its depth's winner or another condition is open, and the outcomes differ by more than twice the
    /// widest of them.
    pub is_marked: bool,
}

impl LegalPixel {
    /// The hull of all outcomes, the widest of which is that wide.
    fn new((low, high): (Units, Units), widest: Units) -> Self {
        // Where anything is legal, other outcomes are too.
        let is_marked = (0..4).any(|k| high[k] - low[k] > 2.0 * widest[k] || widest[k] == f64::INFINITY);
        Self { low, high, is_marked }
    }
}

/// A triangle that may cover a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Its draw.
    pub(super) draw: u32,
    /// Its place in the draw.
    pub(super) triangle: u32,
    /// Twice the area that the pixel's middle spans with each edge.
    pub(super) edges: [f64; 3],
    /// Which of these may have the other sign.
    pub(super) open: [bool; 3],
    /// Whether it covers the pixel where nothing is moved.
    pub(super) covers: bool,
}

/// A fragment that a pixel shows, by its candidate and its outcome among that one's, or [`EACH`].
type Layer = (u32, u32);

/// Any of a candidate's outcomes.
const EACH: u32 = u32::MAX;

/// An outcome of a candidate: the colour, and whether a cutout keeps it (1) or not (0).
type Outcome = (Rgba<Accept>, Accept);

/// What a pixel shows, the lowest first. Few pixels have more than one layer, so that there is seldom anything to allocate.
type Layers = SmallVec<[Layer; 4]>;

/// The candidates that are there.
type Present = SmallVec<[u32; 8]>;

/// What one way through a pixel's depth tests leaves.
#[derive(Clone, Debug)]
struct Way {
    depth: (f64, f64),
    /// The draw's place and the triangle whose depth that is.
    owner: Option<(usize, usize)>,
    layers: Layers,
}

/// Most pixels come about in one way.
type Few<T> = SmallVec<[T; 2]>;

/// Works out pixels one after the other.
pub(super) struct Painter<'a> {
    frame: &'a Frame,
    draws: &'a [Prepared<'a>],
    stage: Option<Intermediate>,
    target: TargetFormat,
    background: (Units, Units),
    scratch: Scratch<Accept>,
    attributes: Vec<Accept>,
    /// Of the candidates that are shaded so far, one after the other.
    outcomes: Vec<Outcome>,
    /// Which are a candidate's, once they are known.
    known: Vec<Option<Range<u32>>>,
}

impl<'a> Painter<'a> {
    pub(super) fn new(frame: &'a Frame, draws: &'a [Prepared<'a>], stage: Option<Intermediate>) -> Self {
        let target = if stage.is_some() { TargetFormat::Rgba32Float } else { frame.target.format };
        // Converting the colour that a target is cleared to is a store as any other.
        let color = if stage.is_some() { [0.0; 4] } else { frame.background.map(f64::from) };
        let background = over(target, None, color.map(|c| (c, c)), [0.0; 4], ([0.0; 4], [0.0; 4]));
        Self {
            frame,
            draws,
            stage,
            target,
            background,
            scratch: Scratch::default(),
            attributes: vec![],
            outcomes: vec![],
            known: vec![],
        }
    }

    /// The legal values of a pixel, from all that may cover it, in the order of drawing.
    pub(super) fn pixel(&mut self, candidates: &[Candidate]) -> LegalPixel {
        if candidates.is_empty() {
            return LegalPixel::new(self.background, width(self.background));
        }
        self.outcomes.clear();
        self.known.clear();
        self.known.resize(candidates.len(), None);
        let Some(presences) = self.presences(candidates) else { return ANYTHING };
        let mut seen: Few<Layers> = SmallVec::new();
        for present in presences {
            let Some(ways) = self.ways(candidates, &present) else { return ANYTHING };
            for way in ways {
                if !seen.contains(&way.layers) {
                    seen.push(way.layers);
                }
            }
            if seen.len() > MOST {
                return ANYTHING;
            }
        }
        let mut all: Option<(Units, Units)> = None;
        let mut widest = [0.0_f64; 4];
        for layers in &seen {
            for color in self.colors(candidates, layers) {
                let width = width(color);
                widest = std::array::from_fn(|k| widest[k].max(width[k]));
                all = Some(all.map_or(color, |so_far| hull(so_far, color)));
            }
        }
        LegalPixel::new(all.unwrap_or(self.background), widest)
    }

    /// Which candidates cover the pixel, in each way that coverage may turn out; `None` where there are too many.
    fn presences(&self, candidates: &[Candidate]) -> Option<Few<Present>> {
        let is_open = |c: &Candidate| c.open.contains(&true) || self.may_vanish(c);
        let (mut open, mut certain) = (Present::new(), Present::new());
        for (k, candidate) in (0..).zip(candidates) {
            if is_open(candidate) { open.push(k) } else { certain.push(k) }
        }
        let mut ways: Few<Present> = smallvec![certain];
        while let Some(&first) = open.first() {
            let alike = |&k: &u32| self.is_alike(&candidates[first as usize], &candidates[k as usize]);
            let (group, rest): (Present, Present) = open.into_iter().partition(alike);
            open = rest;
            let alternatives = self.alternatives(candidates, &group)?;
            if ways.len() * alternatives.len() > MOST {
                return None;
            }
            ways = ways
                .iter()
                .flat_map(|way| alternatives.iter().map(move |more| way.iter().chain(more).copied().collect()))
                .collect();
        }
        for way in &mut ways {
            way.sort_unstable();
        }
        Some(ways)
    }

    fn may_vanish(&self, candidate: &Candidate) -> bool {
        self.draws[candidate.draw as usize].outlines[candidate.triangle as usize].may_vanish
    }

    /// Whether two triangles are of one draw and turned the same way.
    fn is_alike(&self, a: &Candidate, b: &Candidate) -> bool {
        let front = |c: &Candidate| self.draws[c.draw as usize].geometry.triangles[c.triangle as usize].is_front;
        a.draw == b.draw && front(a) == front(b)
    }

    /// The ways in which triangles of one draw, turned the same way and each open, may cover a pixel.
    ///
    /// Moving vertices moves both triangles at a shared edge alike. Where every edge that is open is shared by two of
    /// them, the number of triangles that cover the pixel cannot change: where it is one, it is always one of them.
    fn alternatives(&self, candidates: &[Candidate], group: &[u32]) -> Option<Few<Present>> {
        let paired = group.iter().all(|&k| !self.may_vanish(&candidates[k as usize]))
            && self.open_edges_are_shared(candidates, group);
        let covering = group.iter().filter(|&&k| candidates[k as usize].covers).count();
        if paired && covering <= 1 {
            let each = || group.iter().map(|&k| smallvec![k]).collect();
            return Some(if covering == 1 { each() } else { smallvec![Present::new()] });
        }
        if group.len() > 6 {
            return None;
        }
        let subsets = 0..1_u32 << group.len();
        Some(subsets.map(|set| (0..group.len()).filter(|k| set >> k & 1 == 1).map(|k| group[k]).collect()).collect())
    }

    fn open_edges_are_shared(&self, candidates: &[Candidate], group: &[u32]) -> bool {
        let mut edges: SmallVec<[(u64, u64); 8]> = SmallVec::new();
        for &k in group {
            let candidate = &candidates[k as usize];
            let geometry = &self.draws[candidate.draw as usize].geometry;
            let vertices = geometry.triangles[candidate.triangle as usize].vertices;
            for edge in (0..3).filter(|&edge| candidate.open[edge]) {
                let (from, to) = (vertices[(edge + 1) % 3], vertices[(edge + 2) % 3]);
                let (from, to) = (geometry.identities[from], geometry.identities[to]);
                // Its other side cancels it.
                match edges.iter().position(|&other| other == (to, from)) {
                    Some(other) => {
                        edges.swap_remove(other);
                    }
                    None => edges.push((from, to)),
                }
            }
        }
        edges.is_empty()
    }

    /// The ways through the depth tests of the fragments that are there; `None` where there are too many.
    fn ways(&mut self, candidates: &[Candidate], present: &[u32]) -> Option<Few<Way>> {
        let clear = f64::from(self.frame.clear_depth);
        let mut ways: Few<Way> = smallvec![Way { depth: (clear, clear), owner: None, layers: Layers::new() }];
        for &k in present {
            let candidate = &candidates[k as usize];
            let prepared = &self.draws[candidate.draw as usize];
            let triangle = &prepared.geometry.triangles[candidate.triangle as usize];
            let depth = prepared.surface(candidate.triangle as usize).depth(triangle, candidate.edges);
            let owner = (prepared.place, triangle.source);
            let (test, is_opaque) = (prepared.draw.depth, prepared.draw.blend.is_none() || self.stage.is_some());
            let is_cutout = prepared.draw.cutout.is_some();
            let outcomes = if is_cutout { self.shaded(candidates, k) } else { 0..1 };
            let mut left: Few<Way> = SmallVec::new();
            for way in ways {
                let passes = test
                    .map_or((true, false), |test| may_pass(test.compare, depth, way.depth, way.owner == Some(owner)));
                let mut may_stay = passes.1;
                if passes.0 {
                    for outcome in outcomes.clone() {
                        let (keeps, drops) = if is_cutout { self.kept(outcome) } else { (true, false) };
                        may_stay |= drops;
                        if keeps {
                            let mut layers = if is_opaque { Layers::new() } else { way.layers.clone() };
                            layers.push((k, if is_cutout { outcome } else { EACH }));
                            let writes = test.is_some_and(|test| test.write);
                            let (depth, owner) = if writes { (depth, Some(owner)) } else { (way.depth, way.owner) };
                            left.push(Way { depth, owner, layers });
                        }
                    }
                }
                if may_stay {
                    left.push(way);
                }
            }
            if left.len() > MOST {
                return None;
            }
            ways = left;
        }
        Some(ways)
    }

    /// Whether a cutout may keep an outcome, and whether it may drop it.
    fn kept(&self, outcome: u32) -> (bool, bool) {
        let kept = self.outcomes[outcome as usize].1;
        (kept.high() > 0.5, kept.low() < 0.5)
    }

    /// Shades a candidate, once; which outcomes are its.
    fn shaded(&mut self, candidates: &[Candidate], k: u32) -> Range<u32> {
        if let Some(known) = &self.known[k as usize] {
            return known.clone();
        }
        let candidate = &candidates[k as usize];
        let prepared = &self.draws[candidate.draw as usize];
        let number = candidate.triangle as usize;
        let (triangle, surface) = (&prepared.geometry.triangles[number], prepared.surface(number));
        let given = (triangle, &prepared.geometry);
        surface.attributes(given, &prepared.shader.attributes, candidate.edges, &mut self.attributes);
        let (low, high) = surface.depth(triangle, candidate.edges);
        let (stage, scratch, attributes) = (self.stage, &mut self.scratch, &self.attributes);
        let first = self.outcomes.len();
        let found = &mut self.outcomes;
        paths::each(
            || prepared.shader.fragment(attributes, scratch),
            |fragment| {
                let color = match stage {
                    Some(stage) => fragment.at(stage, Accept::from_bounds(low, high)),
                    None => fragment.color,
                };
                found.push((color, fragment.kept));
            },
        );
        let place = |outcome: usize| u32::try_from(outcome).expect("each candidate has few outcomes");
        let known = place(first)..place(self.outcomes.len());
        self.known[k as usize] = Some(known.clone());
        known
    }

    /// What layers over the background may leave, by each way through their shading.
    fn colors(&mut self, candidates: &[Candidate], layers: &[Layer]) -> Few<(Units, Units)> {
        let mut left: Few<(Units, Units)> = smallvec![self.background];
        for &(k, outcome) in layers {
            let all = self.shaded(candidates, k);
            let blend = self.draws[candidates[k as usize].draw as usize].draw.blend.filter(|_| self.stage.is_none());
            let state = blend.map(|blend| blend.state);
            let constant = blend.map_or([0.0; 4], |blend| blend.constant);
            let chosen = if outcome == EACH { all } else { outcome..outcome + 1 };
            let sources = &self.outcomes[chosen.start as usize..chosen.end as usize];
            let bounds = |(color, _): &Outcome| color.0.map(|c| (c.low(), c.high()));
            let target = self.target;
            left = left
                .iter()
                .flat_map(|&below| {
                    sources.iter().map(move |source| over(target, state, bounds(source), constant, below))
                })
                .collect();
            if left.len() > MOST {
                left = left.into_iter().reduce(hull).into_iter().collect();
            }
        }
        left
    }
}

const ANYTHING: LegalPixel = LegalPixel { low: [f64::NEG_INFINITY; 4], high: [f64::INFINITY; 4], is_marked: true };

fn width((low, high): (Units, Units)) -> Units {
    std::array::from_fn(|k| high[k] - low[k])
}

fn hull(a: (Units, Units), b: (Units, Units)) -> (Units, Units) {
    (std::array::from_fn(|k| a.0[k].min(b.0[k])), std::array::from_fn(|k| a.1[k].max(b.1[k])))
}

/// Whether a depth may pass against another, and whether it may fail. The same triangle drawn again has the same depth.
fn may_pass(compare: Compare, new: (f64, f64), old: (f64, f64), is_same: bool) -> (bool, bool) {
    let (less, equal, greater) =
        if is_same { (false, true, false) } else { (new.0 < old.1, new.0 <= old.1 && new.1 >= old.0, new.1 > old.0) };
    let passes_when = |bit: u32| compare.code() >> bit & 1 == 1;
    let cases = [(less, passes_when(0)), (equal, passes_when(1)), (greater, passes_when(2))];
    (cases.iter().any(|&(may, passes)| may && passes), cases.iter().any(|&(may, passes)| may && !passes))
}
