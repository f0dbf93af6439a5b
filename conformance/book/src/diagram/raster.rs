//! Diagrams of what the rasteriser and the depth test do: primitives, windings, clipping, and which depth is seen.

use super::{arrow, dot, figure, fixed};
use lightmeter_scene::depth::Compare;
use lightmeter_scene::raster::{Provoking, Raster, Topology};
use maud::{Markup, html};

/// The diagram of a case of the rasteriser; `None` where what goes in and what comes out says as much.
pub(super) fn raster(raster: Raster) -> Option<Markup> {
    Some(match raster {
        Raster::TriangleAttributes | Raster::TrianglePosition => pixels(),
        Raster::LineAttributes => line(),
        Raster::Quad => quad(),
        Raster::OwnDepth => return None,
        Raster::Facing => facing(),
        Raster::Clipped => clipped(),
        Raster::Culled { back, front_is_ccw } => culled(back, front_is_ccw),
        Raster::SameDepth(compare) => same_depth(compare),
        Raster::Flat { topology, provoking } => flat(topology, provoking),
    })
}

/// Pixels of a raster whose centres lie in one of some triangles, with their outlines.
fn raster_of(triangles: &[[[f64; 2]; 3]]) -> Markup {
    let side = |a: [f64; 2], b: [f64; 2], [x, y]: [f64; 2]| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    let is_in = |corners: &[[f64; 2]; 3], p| (0..3).all(|k| side(corners[k], corners[(k + 1) % 3], p) > 0.0);
    html! {
        @for row in 0..6 { @for column in 0..12 {
            @let (x, y) = (f64::from(50 + 25 * column), f64::from(25 + 25 * row));
            @let centre = [x + 12.5, y + 12.5];
            rect class=(if triangles.iter().any(|corners| is_in(corners, centre)) { "cell in" } else { "cell" }) x=(x) y=(y) width="25" height="25" {}
            circle.center cx=(centre[0]) cy=(centre[1]) r="1.5" {}
        } }
        @for corners in triangles { polygon.outline points=(points(corners)) {} }
    }
}

fn points(corners: &[[f64; 2]]) -> String {
    corners.iter().map(|[x, y]| format!("{},{}", fixed(*x), fixed(*y))).collect::<Vec<_>>().join(" ")
}

fn pixels() -> Markup {
    let body = raster_of(&[[[70.0, 25.0], [330.0, 75.0], [150.0, 172.0]]]);
    figure(400, 190, "A pixel is covered where its centre lies inside", &body)
}

fn quad() -> Markup {
    let [a, b, c, d] = [[70.0, 40.0], [310.0, 32.0], [335.0, 168.0], [95.0, 160.0]];
    let body = raster_of(&[[a, b, c], [a, c, d]]);
    figure(400, 190, "A pixel on the edge that two triangles share belongs to exactly one of them", &body)
}

fn line() -> Markup {
    let body = html! {
        (raster_of(&[]))
        line.surface x1="70" y1="150" x2="330" y2="50" {}
        (dot([70.0, 150.0], "a")) (dot([330.0, 50.0], "b"))
        circle.lamp cx="212.5" cy="87.5" r="4" {}
    };
    figure(
        400,
        190,
        "A pixel beside the line has the attribute of the place on the line that is nearest to its centre",
        &body,
    )
}

/// A triangle with the order of its vertices, as it is seen on the screen.
fn wound(left: f64, is_ccw: bool, is_filled: bool, name: &str) -> Markup {
    let corners = [[left, 130.0], [left + 110.0, 130.0], [left + 55.0, 40.0]];
    let order = if is_ccw { [0, 1, 2] } else { [0, 2, 1] };
    html! {
        polygon class=(if is_filled { "part-a" } else { "outline" }) points=(points(&corners)) {}
        @for k in 0..3 { (arrow(corners[order[k]], corners[order[(k + 1) % 3]], "", "main")) }
        text x=(fixed(left + 55.0)) y="160" text-anchor="middle" { @if is_ccw { "counter-clockwise" } @else { "clockwise" } }
        text x=(fixed(left + 55.0)) y="178" text-anchor="middle" { (name) }
    }
}

fn culled(back: bool, front_is_ccw: bool) -> Markup {
    let says = |is_ccw: bool| {
        let is_front = is_ccw == front_is_ccw;
        let is_culled = is_front != back;
        (
            !is_culled,
            format!("{}, {}", if is_front { "front" } else { "back" }, if is_culled { "culled" } else { "drawn" }),
        )
    };
    let ((left_stays, left), (right_stays, right)) = (says(true), says(false));
    let body = html! { (wound(60.0, true, left_stays, &left)) (wound(230.0, false, right_stays, &right)) };
    figure(400, 190, "The order of the vertices on the screen says which face is seen, and that which is culled", &body)
}

fn facing() -> Markup {
    let body = html! { (wound(60.0, true, true, "")) (wound(230.0, false, false, "")) };
    figure(400, 190, "The order of the vertices on the screen says which face is seen", &body)
}

fn clipped() -> Markup {
    let body = html! {
        rect.surface x="120" y="20" width="160" height="150" fill="none" {} text x="126" y="36" { "clip volume" }
        polygon.outline points="60,150 220,50 240,150" {}
        polygon.part-a points="120,112.5 220,50 240,150 120,150" {}
        (dot([60.0, 150.0], ""))
    };
    figure(400, 190, "What lies outside of the clip volume is cut off, and covers no pixel", &body)
}

fn same_depth(compare: Compare) -> Markup {
    const EQUAL: u32 = 2;
    let passes = compare.code() & EQUAL != 0;
    let body = html! {
        line.surface x1="40" y1="90" x2="370" y2="90" {} text x="40" y="112" { "0" } text x="362" y="112" { "1" }
        line.mark x1="200" y1="50" x2="200" y2="100" {} text x="190" y="42" text-anchor="end" { "first drawing" } text x="210" y="42" { "second drawing" }
        text x="205" y="130" text-anchor="middle" { (compare.name()) @if passes { " passes equal depths: 2 is seen" } @else { " fails equal depths: 1 stays" } }
    };
    figure(400, 145, "Both drawings have the same depth at the pixel", &body)
}

/// The depths that pass a test against the one that is there.
pub(super) fn depth_test(compare: Compare) -> Markup {
    const LESS: u32 = 1;
    const EQUAL: u32 = 2;
    const GREATER: u32 = 4;
    let passes = |bit: u32| compare.code() & bit != 0;
    let body = html! {
        @if passes(LESS) { rect.part-a x="40" y="78" width="158" height="24" {} }
        @if passes(GREATER) { rect.part-a x="202" y="78" width="168" height="24" {} }
        @if passes(EQUAL) { rect.part-a x="198" y="78" width="4" height="24" {} }
        line.surface x1="40" y1="90" x2="370" y2="90" {} text x="40" y="122" { "0" } text x="362" y="122" { "1" }
        line.mark x1="200" y1="50" x2="200" y2="105" {} text x="200" y="42" text-anchor="middle" { "old depth" }
        text x="205" y="140" text-anchor="middle" { @if compare == Compare::Never { "no new depth passes" } @else { "new depths that pass are coloured" } }
    };
    figure(400, 155, "The depth that is drawn is compared with the one that is there", &body)
}

fn flat(topology: Topology, provoking: Provoking) -> Markup {
    let at = |k: usize| {
        #[expect(clippy::cast_precision_loss, reason = "six vertices")]
        let x = 60.0 + 55.0 * k as f64;
        [x, if k.is_multiple_of(2) { 125.0 } else { 45.0 }]
    };
    const VERTICES: usize = 6;
    let corners = topology.corners() as usize;
    let is_strip = matches!(topology, Topology::LineStrip | Topology::TriangleStrip);
    let step = if is_strip { 1 } else { corners };
    let firsts: Vec<usize> = (0..=VERTICES - corners).step_by(step).collect();
    let body = html! {
        @for (m, &first) in firsts.iter().enumerate() {
            @let own: Vec<[f64; 2]> = (first..first + corners).map(at).collect();
            @if let [from, to] = own[..] { line.surface x1=(from[0]) y1=(from[1]) x2=(to[0]) y2=(to[1]) {} }
            @if corners == 3 { polygon class=(if m % 2 == 0 { "part-a" } else { "part-b" }) points=(points(&own)) {} }
        }
        @for k in 0..VERTICES { (dot(at(k), &format!("a{k}"))) }
        @for (m, &first) in firsts.iter().enumerate().filter(|_| corners > 1) {
            @let own: Vec<[f64; 2]> = (first..first + corners).map(at).collect();
            @let middle = [0, 1].map(|axis| own.iter().map(|corner| corner[axis]).sum::<f64>() / f64::from(topology.corners()));
            @let from = match provoking { Provoking::First => first, Provoking::Last => first + corners - 1 };
            @let beside = if corners == 2 { 24.0 } else { 0.0 };
            text x=(fixed(middle[0] + beside)) y=(fixed(middle[1] + 4.0)) text-anchor="middle" { (m) ": a" (from) }
        }
    };
    let says = match (corners, provoking) {
        (1, _) => "Each vertex is a primitive by itself, so that its first and its last vertex are the same",
        (_, Provoking::First) => "Each primitive by its number, and its attribute: that of its first vertex",
        (_, Provoking::Last) => "Each primitive by its number, and its attribute: that of its last vertex",
    };
    figure(400, 165, says, &body)
}
