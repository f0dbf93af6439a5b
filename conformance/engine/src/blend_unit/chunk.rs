//! Blend states with their cases, cut into chunks that a submission holds.

use crate::piece::Piece;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{CaseRef, Member, Selected};
use lightmeter_scene::blend::{Route, routes};
use rayon::prelude::*;

/// Pixels of a submission.
const PIXELS: usize = 1 << 17;
/// Cases of a state that are taken at once.
const BLOCK: usize = 1 << 15;

/// Pieces of a chunk, and whose they are.
pub(super) struct UnitChunk<'a> {
    pub(super) members: Vec<&'a Member>,
    pub(super) cases: Vec<Vec<CaseRef>>,
    pub(super) pieces: Vec<Piece>,
}

/// A state by a route with some of its cases.
pub(super) type Part<'a> = (&'a Member, Route, Vec<CaseRef>);

/// A group's states by each of their routes, cut into blocks of cases. A renderer that is asked case by case has its own ways.
pub(super) fn parts<'a>(
    members: &'a [&'a Member],
    group: &'a [Selected],
    is_asked: bool,
) -> impl Iterator<Item = Part<'a>> {
    members.iter().zip(group).flat_map(move |(member, chosen)| {
        let Kind::Blend(program) = member.spec.kind else { unreachable!("only blend states are drawn by the unit") };
        let mut cases = chosen.cases();
        let blocks = std::iter::from_fn(move || {
            let block: Vec<CaseRef> = cases.by_ref().take(BLOCK).collect();
            (!block.is_empty()).then_some(block)
        });
        let routes = if is_asked { &[Route::Native] } else { routes(program.layer(0).0) };
        blocks.flat_map(move |block| routes.iter().map(move |route| (*member, *route, block.clone())))
    })
}

impl<'a> UnitChunk<'a> {
    /// The next parts that fill a submission.
    pub(super) fn next(parts: &mut impl Iterator<Item = Part<'a>>, seed: u64) -> Self {
        let (mut taken, mut pixels) = (vec![], 0);
        while pixels < PIXELS {
            let Some(part) = parts.next() else { break };
            pixels += part.2.len();
            taken.push(part);
        }
        let pieces = taken.par_iter().map(|(member, route, cases)| {
            let (draws, mut inputs) = (member.draws(seed), vec![]);
            for &case in cases {
                draws.inputs(case, &mut inputs);
            }
            let Kind::Blend(program) = member.spec.kind else { unreachable!("checked where the parts are made") };
            Piece { program, route: *route, inputs, stride: member.spec.input_len() }
        });
        let pieces = pieces.collect();
        let (members, cases) = taken.into_iter().map(|(member, _, cases)| (member, cases)).unzip();
        Self { members, cases, pieces }
    }
}
