//! Markers: a shape and a colour each, so that neither print nor colour-blindness confuses them.

use plotters::style::RGBColor;

/// What a marker looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Marker {
    shape: Shape,
    /// From the palette of Okabe and Ito; greys of the rungs on the processor.
    pub(super) color: RGBColor,
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
    Bar,
}

const GREY: RGBColor = RGBColor(107, 107, 107);

const RUNGS: [(&str, Shape, RGBColor); 9] = [
    ("f16", Shape::Down, RGBColor(230, 159, 0)),
    ("f32-cheap", Shape::Diamond, RGBColor(86, 180, 233)),
    ("f32", Shape::Circle, RGBColor(0, 114, 178)),
    ("f32-stable", Shape::Square, RGBColor(0, 158, 115)),
    ("double-float", Shape::Up, RGBColor(204, 121, 167)),
    ("f64", Shape::Star, RGBColor(213, 94, 0)),
    ("cpu-f32", Shape::Plus, GREY),
    ("cpu-f64", Shape::Cross, GREY),
    ("cpu-accept", Shape::Bar, GREY),
];

/// The marker of a rung by its name, of another row by its place.
pub(crate) fn marker(name: &str, place: usize) -> Marker {
    const OTHERS: [(Shape, RGBColor); 8] = [
        (Shape::Circle, RGBColor(0, 114, 178)),
        (Shape::Up, RGBColor(213, 94, 0)),
        (Shape::Square, RGBColor(0, 158, 115)),
        (Shape::Diamond, RGBColor(230, 159, 0)),
        (Shape::Down, RGBColor(204, 121, 167)),
        (Shape::Star, RGBColor(86, 180, 233)),
        (Shape::Cross, RGBColor(0, 0, 0)),
        (Shape::Plus, RGBColor(168, 154, 0)),
    ];
    let rung = RUNGS.into_iter().find(|(rung, ..)| *rung == name).map(|(_, shape, color)| (shape, color));
    let (shape, color) = rung.unwrap_or(OTHERS[place % OTHERS.len()]);
    Marker { shape, color }
}

impl Marker {
    /// The same shape in the colour of another.
    pub(crate) fn colored_as(self, other: Self) -> Self {
        Self { color: other.color, ..self }
    }

    /// The corners of the shape, `r` pixels from its middle to its side.
    pub(super) fn outline(self, r: f64) -> Vec<(i32, i32)> {
        let round = |corners: usize, turned: f64, reach: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
            let corner = |k: usize| {
                #[expect(clippy::cast_precision_loss, reason = "a few corners")]
                let angle = turned + std::f64::consts::TAU * k as f64 / corners as f64;
                (reach(k) * angle.sin(), -reach(k) * angle.cos())
            };
            (0..corners).map(corner).collect()
        };
        let beam = |width: f64| {
            let (w, r) = (width * r, 1.15 * r);
            vec![
                (-w, -r),
                (w, -r),
                (w, -w),
                (r, -w),
                (r, w),
                (w, w),
                (w, r),
                (-w, r),
                (-w, w),
                (-r, w),
                (-r, -w),
                (-w, -w),
            ]
        };
        let quarter = std::f64::consts::FRAC_PI_4;
        let corners = match self.shape {
            Shape::Circle => round(16, 0.0, &|_| r),
            Shape::Square => round(4, quarter, &|_| 1.25 * r),
            Shape::Diamond => round(4, 0.0, &|_| 1.3 * r),
            Shape::Up => round(3, 0.0, &|_| 1.35 * r),
            Shape::Down => round(3, std::f64::consts::PI, &|_| 1.35 * r),
            Shape::Star => round(10, 0.0, &|k| if k.is_multiple_of(2) { 1.5 * r } else { 0.65 * r }),
            Shape::Plus => beam(0.3),
            Shape::Cross => {
                beam(0.3).into_iter().map(|(x, y)| ((x - y) * quarter.cos(), (x + y) * quarter.cos())).collect()
            }
            Shape::Bar => vec![(-0.4 * r, -1.3 * r), (0.4 * r, -1.3 * r), (0.4 * r, 1.3 * r), (-0.4 * r, 1.3 * r)],
        };
        #[expect(clippy::cast_possible_truncation, reason = "a few pixels")]
        corners.into_iter().map(|(x, y)| (x.round() as i32, y.round() as i32)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rungs_differ_in_shape_and_those_of_shaders_in_colour() {
        for (place, (name, shape, color)) in RUNGS.into_iter().enumerate() {
            for (other, other_shape, other_color) in &RUNGS[..place] {
                assert_ne!(shape, *other_shape, "{name} and {other}");
                assert!(color != *other_color || name.starts_with("cpu-"), "{name} and {other}");
            }
            assert_eq!(marker(name, 3), Marker { shape, color });
        }
        assert_ne!(marker("blinn", 0), marker("phong", 1));
    }
}
