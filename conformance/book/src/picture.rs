//! Pictures that a formula makes: a lit sphere, a strip of colours, a translucent card. The same code draws them with a mistake.

use crate::sketch::Range;
use image::{ExtendedColorType, ImageEncoder as _, codecs::png::PngEncoder};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::Member;
use lightmeter_faults::Variation;
use lightmeter_reference::vector::{halfway, normalize, reflect, toward};
use lightmeter_reference::{Vec3, Vector};
use lightmeter_report::html::embedded;
use maud::{Markup, html};

/// Pixels of a sphere's side.
const SIDE: usize = 96;
/// Pixels of a strip.
const STRIP: [usize; 2] = [192, 20];
/// The distance of a sphere's middle before the eye.
const AWAY: f64 = 4.0;

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Subject {
    /// A sphere that is lit.
    Sphere,
    /// The colour along an input, left to right.
    Strip { input: usize },
    /// Colours from left to right below a card whose alpha goes from 0 at its upper edge to 1 at its lower one.
    Card,
}

/// A picture that a formula makes, as rows of inputs.
#[derive(Clone, Debug)]
pub struct FormulaPicture {
    subject: Subject,
    size: [usize; 2],
    /// A row of inputs for each pixel; none where nothing is drawn.
    rows: Vec<Option<Vec<f32>>>,
    /// Where the colour stands in the outputs, and whether it is a single number.
    color: usize,
    is_grey: bool,
}

impl FormulaPicture {
    /// The picture of a formula; `None` where it gives no colour of which one can be drawn.
    #[must_use]
    pub fn of(member: &Member) -> Option<Self> {
        let spec = &member.spec;
        let color = spec.outputs.iter().position(|output| output.unit == "color" && output.shape.components() >= 3);
        let place = |k: usize| spec.outputs[..k].iter().map(|output| output.shape.components()).sum();
        let base = base(member);
        if matches!(spec.kind, Kind::Blend(_))
            && spec.place("src").is_some_and(|src| src.len() == 4)
            && spec.place("dst").is_some()
        {
            return Some(Self::card(member, &base, place(color?)));
        }
        if let Some(rows) = sphere(member, &base) {
            let (color, is_grey) = color.map_or((0, true), |color| (place(color), false));
            return Some(Self { subject: Subject::Sphere, size: [SIDE; 2], rows, color, is_grey });
        }
        let color = place(color?);
        let input = strip_input(member, &base)?;
        let range = Range::of(member, &base, input)?;
        let row = |x: usize| {
            let mut row = base.clone();
            row[input] = range.at(x, STRIP[0]);
            Some(row)
        };
        let line: Vec<Option<Vec<f32>>> = (0..STRIP[0]).map(row).collect();
        Some(Self { subject: Subject::Strip { input }, size: STRIP, rows: line, color, is_grey: false })
    }

    fn card(member: &Member, base: &[f32], color: usize) -> Self {
        let spec = &member.spec;
        let (src, dst) = (spec.place("src").unwrap_or_default(), spec.place("dst").unwrap_or_default());
        let row = |k: usize| {
            let (x, y) = (k % SIDE, k / SIDE);
            #[expect(clippy::cast_precision_loss, reason = "pixels")]
            let (u, v) = (x as f32 / (SIDE - 1) as f32, y as f32 / (SIDE - 1) as f32);
            let mut row = base.to_vec();
            let below = [0.15 + 0.8 * u, 0.75 - 0.5 * u, 0.25 + 0.2 * (6.0 * u).sin(), 1.0 - 0.5 * u];
            row[dst.clone()].iter_mut().zip(below).for_each(|(to, c)| *to = c);
            row[src.clone()].copy_from_slice(&[0.95, 0.55, 0.1, v]);
            Some(row)
        };
        Self {
            subject: Subject::Card,
            size: [SIDE; 2],
            rows: (0..SIDE * SIDE).map(row).collect(),
            color,
            is_grey: false,
        }
    }

    /// What is to be seen, as a caption.
    #[must_use]
    pub fn caption(&self, member: &Member) -> String {
        match self.subject {
            Subject::Sphere => "a sphere, lit by the formula at every pixel".into(),
            Subject::Strip { input } => format!("the colour as {} grows, left to right", member.spec.input_name(input)),
            Subject::Card if self.is_level(member) => {
                "an orange card over colours, left to right; the alpha of the card changes nothing".into()
            }
            Subject::Card => {
                "an orange card, alpha 0 above and 1 below, over colours whose alpha falls from 1 to ½, left to right"
                    .into()
            }
        }
    }

    /// Whether the colours are the same from the upper edge to the lower one.
    fn is_level(&self, member: &Member) -> bool {
        let mut out = vec![0.0; member.spec.output_len()];
        let mut color = |at: usize| {
            self.rows[at].as_ref().map(|row| {
                member.formula.reference(row, &mut out);
                self.rgb(&out).map(f64::to_bits)
            })
        };
        let [width, height] = self.size;
        (0..width).all(|x| color(x) == color((height - 1) * width + x))
    }

    /// The inputs of the pixels that are drawn, row after row.
    pub fn rows(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        self.rows.iter_mut().flatten()
    }

    /// The colours that come of the outputs of these rows, of all pixels of a line after the other; none where nothing is drawn. And the pixels of a line.
    #[must_use]
    pub fn colors(&self, outputs: &[f64], of_each: usize) -> (usize, Vec<Option<[f64; 3]>>) {
        let mut drawn = outputs.chunks_exact(of_each);
        let color = |row: &Option<Vec<f32>>| row.as_ref().and_then(|_| drawn.next()).map(|out| self.rgb(out));
        let mut colors: Vec<Option<[f64; 3]>> = self.rows.iter().map(color).collect();
        if matches!(self.subject, Subject::Strip { .. }) {
            colors = colors.repeat(STRIP[1]);
        }
        (self.size[0], colors)
    }

    /// Whether the colour is among the outputs that are missing.
    #[must_use]
    pub fn lacks(&self, missing: &[usize]) -> bool {
        let components = if self.is_grey { 1 } else { 3 };
        missing.iter().any(|place| (self.color..self.color + components).contains(place))
    }

    /// The picture by the formula itself, as a file of PNG.
    fn right(&self, member: &Member) -> Vec<u8> {
        let mut out = vec![0.0; member.spec.output_len()];
        self.png(|row| {
            member.formula.reference(row, &mut out);
            self.rgb(&out)
        })
    }

    fn mistaken(&self, member: &Member, variation: &Variation<'_>) -> Vec<u8> {
        let mut out = vec![0.0; member.spec.output_len()];
        self.png(|row| {
            variation.evaluate(row, &mut out);
            self.rgb(&out)
        })
    }

    fn rgb(&self, out: &[f64]) -> [f64; 3] {
        std::array::from_fn(|k| out[if self.is_grey { self.color } else { self.color + k }])
    }

    fn png(&self, mut color: impl FnMut(&[f32]) -> [f64; 3]) -> Vec<u8> {
        let mut colors: Vec<Option<[f64; 3]>> =
            self.rows.iter().map(|row| row.as_ref().map(|row| color(row))).collect();
        if matches!(self.subject, Subject::Strip { .. }) {
            colors = colors.repeat(STRIP[1]);
        }
        png(self.size[0], &colors)
    }

    /// The picture for a page.
    pub(crate) fn img(&self, member: &Member) -> Markup {
        image(&self.right(member), &self.caption(member), self.size)
    }

    /// The picture with a mistake; `None` where it is the same.
    pub(crate) fn img_with(&self, member: &Member, variation: &Variation<'_>) -> Option<Markup> {
        let mistaken = self.mistaken(member, variation);
        (mistaken != self.right(member))
            .then(|| image(&mistaken, &format!("the same if {}", variation.says()), self.size))
    }
}

/// Colours as a file of PNG: clear where there is none, white where a component is NaN.
#[must_use]
pub fn png(width: usize, colors: &[Option<[f64; 3]>]) -> Vec<u8> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a byte")]
    let byte = |c: f64| if c.is_nan() { 255 } else { (255.0 * c.clamp(0.0, 1.0)).round() as u8 };
    let pixel = |color: &Option<[f64; 3]>| color.map_or([0; 4], |[r, g, b]| [byte(r), byte(g), byte(b), 255]);
    let bytes: Vec<u8> = colors.iter().flat_map(pixel).collect();
    let mut file = vec![];
    let [width, height] = [width, colors.len() / width].map(|side| u32::try_from(side).unwrap_or(1));
    let encoded = PngEncoder::new(&mut file).write_image(&bytes, width, height, ExtendedColorType::Rgba8);
    debug_assert!(encoded.is_ok(), "memory takes any picture");
    file
}

fn image(png: &[u8], alt: &str, [width, height]: [usize; 2]) -> Markup {
    html! { img.made src=(embedded("image/png", png)) alt=(alt) width=(width) height=(height); }
}

/// Inputs that look good: colours of their own, a highlight of middling size, the rest in the middle of the domain.
fn base(member: &Member) -> Vec<f32> {
    let mut row = vec![];
    for input in member.spec.inputs {
        let start = row.len();
        input.middle(&mut row);
        let told: &[f32] = match input.name {
            "la" | "ambient_color" => &[0.25, 0.25, 0.3],
            "ld" | "ls" | "light_color" | "color0" | "color1" => &[0.9, 0.9, 0.85, 1.0],
            "ma" => &[0.3, 0.3, 0.5],
            "md" | "diffuse" => &[0.25, 0.45, 0.8, 1.0],
            "ms" | "specular" => &[0.8, 0.8, 0.8, 1.0],
            "ambient" => &[0.06, 0.06, 0.08, 0.0],
            "shininess" => &[20.0],
            "ka" => &[0.2],
            "kd" => &[0.6],
            "ks" => &[0.5],
            "kc" => &[1.0],
            "kl" => &[0.02],
            "kq" => &[0.01],
            "cutoff_cosine" => &[0.93],
            "exponent" => &[12.0],
            "fog" => &[0.75, 0.78, 0.82],
            "shaded" => &[0.75, 0.2, 0.1],
            "dmin" => &[5.0],
            "dmax" => &[60.0],
            "density" => &[0.03],
            _ => &[],
        };
        for (to, &c) in row[start..].iter_mut().zip(told) {
            *to = c;
        }
        if input.name == "density" && input.unit == "1/unit²" {
            row[start] = 0.0009;
        }
    }
    row
}

/// The number along which a strip is drawn: the depth of a point, else the first number that has a range.
fn strip_input(member: &Member, base: &[f32]) -> Option<usize> {
    if let Some(p) = member.spec.place("p") {
        return Some(p.end - 1);
    }
    (0..base.len()).find(|&k| Range::of(member, base, k).is_some())
}

/// A row for each pixel of a sphere before the eye; `None` of a formula that is not told by a normal at a point.
fn sphere(member: &Member, base: &[f32]) -> Option<Vec<Option<Vec<f32>>>> {
    let spec = &member.spec;
    let has = |name: &str| spec.place(name).is_some();
    let is_lit = ["direction", "position", "l", "i", "r", "h"].iter().any(|name| has(name));
    if spec.family() != "lighting" || !is_lit || !(has("normal") || has("n") || has("r")) {
        return None;
    }
    // Of vectors that a formula normalises any length will do, so that a mistake about it is seen.
    let long = |v: Vec3<f64>, by: f64| vector(v.0.map(|x| x * by));
    let position = vector([2.2, 2.4, -1.6]);
    let light = normalize(vector([0.55, 0.6, 0.58]));
    let is_unit =
        spec.inputs.iter().any(|input| input.name == "direction" && spec.input_means(input).contains("unit vector"));
    let pixel = |k: usize| {
        #[expect(clippy::cast_precision_loss, reason = "pixels")]
        let at = |k: usize| (2.0 * (k as f64 + 0.5) / SIDE as f64 - 1.0) * 1.02;
        let (x, y) = (at(k % SIDE), -at(k / SIDE));
        let depth = 1.0 - x * x - y * y;
        if depth < 0.0 {
            return None;
        }
        let n = vector([x, y, depth.sqrt()]);
        let p = vector([x, y, depth.sqrt() - AWAY]);
        let v = normalize(vector([-p.0[0], -p.0[1], -p.0[2]]));
        let minus = |v: Vec3<f64>| vector(v.0.map(|x| -x));
        let mut row = base.to_vec();
        for (name, value) in [
            ("normal", long(n, 0.75)),
            ("n", n),
            ("p", p),
            ("v", v),
            ("l", light),
            ("i", minus(light)),
            (
                "direction",
                if spec.id == "lighting/two-lights" {
                    long(light, 1.4)
                } else if is_unit {
                    minus(light)
                } else {
                    long(minus(light), 1.4)
                },
            ),
            ("position", position),
            ("axis", minus(toward(position, vector([0.15, 0.2, -AWAY + 0.9])))),
            ("r", reflect(minus(light), n)),
            ("h", halfway(v, light)),
        ] {
            let Some(place) = spec.place(name) else { continue };
            #[expect(clippy::cast_possible_truncation, reason = "inputs are f32")]
            row[place].iter_mut().zip(value.0).for_each(|(to, x)| *to = x as f32);
        }
        Some(row)
    };
    Some((0..SIDE * SIDE).map(pixel).collect())
}

fn vector(numbers: [f64; 3]) -> Vec3<f64> {
    Vector(numbers)
}
