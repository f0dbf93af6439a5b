//! Markers: a shape and a colour each, so that neither print nor colour-blindness confuses them.

use std::fmt::{Result, Write};

/// What a marker looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Style {
    shape: Shape,
    /// From the palette of Okabe and Ito; greys of the rungs on the processor.
    pub(super) colour: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    Circle,
    Square,
    Diamond,
    Up,
    Down,
    Star,
    Plus,
    Cross,
    Bars,
}

const RUNGS: [(&str, Shape, &str); 9] = [
    ("f16", Shape::Down, "#E69F00"),
    ("f32-cheap", Shape::Diamond, "#56B4E9"),
    ("f32", Shape::Circle, "#0072B2"),
    ("f32-stable", Shape::Square, "#009E73"),
    ("double-float", Shape::Up, "#CC79A7"),
    ("f64", Shape::Star, "#D55E00"),
    ("cpu-f32", Shape::Plus, "#6b6b6b"),
    ("cpu-f64", Shape::Cross, "#6b6b6b"),
    ("cpu-accept", Shape::Bars, "#6b6b6b"),
];

/// The style of a rung by its name, of another row by its place.
pub(super) fn style(name: &str, place: usize) -> Style {
    const OTHERS: [(Shape, &str); 8] = [
        (Shape::Circle, "#0072B2"),
        (Shape::Up, "#D55E00"),
        (Shape::Square, "#009E73"),
        (Shape::Diamond, "#E69F00"),
        (Shape::Down, "#CC79A7"),
        (Shape::Star, "#56B4E9"),
        (Shape::Cross, "#000000"),
        (Shape::Plus, "#A89A00"),
    ];
    let rung = RUNGS.into_iter().find(|(rung, ..)| *rung == name).map(|(_, shape, colour)| (shape, colour));
    let (shape, colour) = rung.unwrap_or(OTHERS[place % OTHERS.len()]);
    Style { shape, colour }
}

/// Draws a marker, `r` pixels from its middle to its side; hollow, it is one that is wrong in value.
pub(super) fn mark(style: Style, [x, y]: [f64; 2], r: f64, is_hollow: bool, out: &mut impl Write) -> Result {
    let Style { shape, colour } = style;
    let path = outline(shape, r);
    write!(out, r#"<path transform="translate({x:.1},{y:.1})" d="{path}" "#)?;
    if matches!(shape, Shape::Plus | Shape::Cross | Shape::Bars) {
        writeln!(out, r#"fill="none" stroke="{colour}" stroke-width="{:.1}"/>"#, (r * 0.4).max(1.2))
    } else if is_hollow {
        writeln!(out, r##"fill="#ffffff" stroke="{colour}" stroke-width="1.8" stroke-dasharray="2.5 1.5"/>"##)
    } else {
        writeln!(out, r##"fill="{colour}" stroke="#ffffff" stroke-width="{:.1}"/>"##, (r * 0.15).max(0.4))
    }
}

fn outline(shape: Shape, r: f64) -> String {
    let polygon = |points: &[[f64; 2]]| {
        let corners: Vec<String> = points.iter().map(|[x, y]| format!("{:.1} {:.1}", r * x, r * y)).collect();
        format!("M{}z", corners.join("L"))
    };
    let d = 0.75 * r;
    match shape {
        Shape::Circle => format!("M{r:.1} 0A{r:.1} {r:.1} 0 1 1 -{r:.1} 0A{r:.1} {r:.1} 0 1 1 {r:.1} 0z"),
        Shape::Square => polygon(&[[-0.88, -0.88], [0.88, -0.88], [0.88, 0.88], [-0.88, 0.88]]),
        Shape::Diamond => polygon(&[[0.0, -1.25], [1.1, 0.0], [0.0, 1.25], [-1.1, 0.0]]),
        Shape::Up => polygon(&[[0.0, -1.2], [1.1, 0.8], [-1.1, 0.8]]),
        Shape::Down => polygon(&[[0.0, 1.2], [1.1, -0.8], [-1.1, -0.8]]),
        Shape::Star => polygon(&std::array::from_fn::<_, 10, _>(|k| {
            let turn = f64::from(u8::try_from(k).unwrap_or_default()) * std::f64::consts::PI / 5.0;
            let reach = if k % 2 == 0 { 1.35 } else { 0.6 };
            [reach * turn.sin(), -reach * turn.cos()]
        })),
        Shape::Plus => format!("M-{r:.1} 0H{r:.1}M0 -{r:.1}V{r:.1}"),
        Shape::Cross => format!("M-{d:.1} -{d:.1}L{d:.1} {d:.1}M-{d:.1} {d:.1}L{d:.1} -{d:.1}"),
        Shape::Bars => format!("M-{d:.1} -{r:.1}V{r:.1}M{d:.1} -{r:.1}V{r:.1}M-{d:.1} 0H{d:.1}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rungs_differ_in_shape_and_those_of_shaders_in_colour() {
        for (place, (name, shape, colour)) in RUNGS.into_iter().enumerate() {
            for (other, other_shape, other_colour) in &RUNGS[..place] {
                assert_ne!(shape, *other_shape, "{name} and {other}");
                assert!(colour != *other_colour || name.starts_with("cpu-"), "{name} and {other}");
            }
            assert_eq!(style(name, 3), Style { shape, colour });
        }
        assert_ne!(style("blinn", 0), style("phong", 1));
    }
}
