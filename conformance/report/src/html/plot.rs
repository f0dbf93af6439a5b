//! Plots of a page: drawn as SVG in the page's own colours, so that they are as legible by night.

use super::matrix::short;
use lightmeter_document::explained::{CoursePoint, OutputCourse};
use lightmeter_document::superscript;
use lightmeter_document::sweep::{SweepDocument, SweepPart};
use maud::{Markup, html};

/// Pixels of a plot: across, upwards, to the left of it, and around.
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 200.0;
const LEFT: f64 = 76.0;
const AROUND: f64 = 14.0;
/// The greatest power of ten of an error that is told from more.
const MOST_POWER: f64 = 8.0;

/// Where a value lies beside what is legal.
pub(super) fn line(low: f64, high: f64, reference: f64, value: f64) -> Markup {
    let all = [low, high, reference, value];
    let (least, most) =
        (all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    if !all.iter().all(|x| x.is_finite()) || least >= most {
        return html! {};
    }
    let x = |value: f64| format!("{:.1}", 12.0 + (WIDTH - 24.0) * (value - least) / (most - least));
    let width = format!("{:.1}", ((WIDTH - 24.0) * (high - low) / (most - least)).max(1.5));
    html! {
        svg.line viewBox={ "0 0 " (WIDTH) " 40" } role="img" aria-label={ "the value " (short(value)) " beside the legal ones, " (short(low)) " to " (short(high)) } {
            line.axis x1="12" x2=(WIDTH - 12.0) y1="20" y2="20" {}
            rect.band x=(x(low)) width=(width) y="12" height="16" {}
            line.reference x1=(x(reference)) x2=(x(reference)) y1="10" y2="30" {}
            circle.value cx=(x(value)) cy="20" r="5" {}
        }
        p.hint { span.key-band {} " legal  " span.key-value {} " answer" }
    }
}

/// What is shown upwards, and how far it goes: a little farther than its values.
struct Axis {
    /// The least and the greatest value.
    values: [f64; 2],
    least: f64,
    most: f64,
    top: f64,
}

impl Axis {
    fn of(values: impl Iterator<Item = f64>, top: f64) -> Option<Self> {
        let finite: Vec<f64> = values.filter(|x| x.is_finite()).collect();
        let (least, most) = (
            finite.iter().copied().fold(f64::INFINITY, f64::min),
            finite.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        );
        if least > most {
            return None;
        }
        let room = if most > least { 0.05 * (most - least) } else { 0.5 * most.abs().max(1.0) };
        Some(Self { values: [least, most], least: least - room, most: most + room, top })
    }

    /// The axis of values, and of what is legal beside them where that does not push them together.
    fn with_band(course: &OutputCourse, value: Option<f64>) -> Option<Self> {
        const MOST_TIMES: f64 = 2.0;
        let values = || {
            let own = |point: &CoursePoint| [Some(point.reference.0), point.mistaken.map(|x| x.0)];
            course.points.iter().flat_map(own).flatten().chain(value)
        };
        let plain = Self::of(values(), AROUND)?;
        let ends = course.points.iter().flat_map(|point| point.interval).map(|end| end.0);
        let whole = Self::of(values().chain(ends), AROUND)?;
        Some(if whole.span() <= MOST_TIMES * plain.span() { whole } else { plain })
    }

    fn span(&self) -> f64 {
        self.values[1] - self.values[0]
    }

    /// The values that are written beside it: the least, the middle and the greatest, or the only one.
    fn ticks(&self) -> Vec<f64> {
        let [least, most] = self.values;
        if least < most { vec![least, f64::midpoint(least, most), most] } else { vec![least] }
    }

    fn y(&self, value: f64) -> f64 {
        let share = (value - self.least) / (self.most - self.least);
        self.top + HEIGHT * (1.0 - share.clamp(-0.02, 1.02))
    }
}

/// The x of an input.
fn across(course: &OutputCourse, x: f64) -> f64 {
    let (from, to) =
        (course.points.first().map_or(0.0, |point| point.x.0), course.points.last().map_or(1.0, |point| point.x.0));
    let share = if course.is_logarithmic { (x / from).ln() / (to / from).ln() } else { (x - from) / (to - from) };
    LEFT + (WIDTH - LEFT - AROUND) * share
}

/// A path through points, broken where one is no number.
fn path(points: impl Iterator<Item = (f64, f64)>) -> String {
    let (mut path, mut is_begun) = (String::new(), false);
    for (x, y) in points {
        if !(x.is_finite() && y.is_finite()) {
            is_begun = false;
            continue;
        }
        path += &format!("{}{x:.1} {y:.1}", if is_begun { "L" } else { "M" });
        is_begun = true;
    }
    path
}

/// How many tolerances a value is from the reference, towards the side that it lies on.
fn margin(point: &CoursePoint, value: f64) -> f64 {
    let [low, high] = point.interval;
    let away = value - point.reference.0;
    let reach = if away < 0.0 { point.reference.0 - low.0 } else { high.0 - point.reference.0 };
    if away == 0.0 { 0.0 } else { away / reach }
}

/// A margin on a scale that is even up to 1 and logarithmic beyond.
fn folded(margin: f64) -> f64 {
    let size = margin.abs();
    let folded = if size <= 1.0 { size } else { 1.0 + size.log10().min(MOST_POWER) };
    folded.copysign(margin)
}

/// An output along an input: what it is to be, what the mistake makes of it, and by how many tolerances that is off.
#[must_use]
pub fn course(course: &OutputCourse, value: Option<f64>) -> Markup {
    let Some(axis) = Axis::with_band(course, value) else { return html! {} };
    let has_band = is_band_seen(course, &axis);
    let x = |x: f64| across(course, x);
    let has_mistake = course.points.iter().any(|point| point.mistaken.is_some());
    let band = band(course, &axis);
    let reference = path(course.points.iter().map(|point| (x(point.x.0), axis.y(point.reference.0))));
    let mistaken = path(
        course.points.iter().map(|point| (x(point.x.0), point.mistaken.map_or(f64::NAN, |value| axis.y(value.0)))),
    );
    let unit = course.unit.as_ref().filter(|unit| !matches!(&***unit, "1" | "color"));
    let unit = unit.map_or_else(String::new, |unit| format!(" ({unit})"));
    let below = AROUND + HEIGHT + 30.0;
    let errors = errors_of(course, value);
    let whole = if errors.is_some() { below + HEIGHT + 44.0 } else { below + 14.0 };
    html! {
        figure.plot {
            svg viewBox={ "0 0 " (WIDTH) " " (whole) } role="img" aria-label={ (course.output) " along " (course.input) } {
                (ticks(&axis, &axis.ticks(), short))
                (frame(AROUND))
                path.band d=(band) {}
                path.reference d=(reference) {}
                @if has_mistake { path.mistaken d=(mistaken) {} }
                @if let Some(value) = value.filter(|value| value.is_finite()) { circle.value cx=(x(course.at.0)) cy=(axis.y(value)) r="4" {} }
                text.name x=(LEFT) y=(AROUND - 4.0) { (course.output) }
                @if let Some((axis, band, path, dot)) = &errors {
                    (ticks(axis, &margin_ticks(axis), unfolded))
                    (frame(axis.top))
                    path.band d=(band) {}
                    path.mistaken d=(path) {}
                    @if let Some(dot) = dot { circle.value cx=(x(course.at.0)) cy=(dot) r="4" {} }
                    text.name x=(LEFT) y=(axis.top - 4.0) { "error over tolerance" }
                }
                @for (place, anchor) in [(0.0, "start"), (1.0, "end")] {
                    @let end = if place == 0.0 { course.points.first() } else { course.points.last() };
                    text.tick x=(LEFT + (WIDTH - LEFT - AROUND) * place) y=(whole - 22.0) text-anchor=(anchor) { (end.map_or_else(String::new, |point| short(point.x.0))) }
                }
                text.name x=(f64::midpoint(LEFT, WIDTH)) y=(whole - 6.0) text-anchor="middle" { (course.input) (unit) @if course.is_logarithmic { ", by its logarithm" } }
            }
            figcaption {
                span.key-reference {} " reference  "
                @if has_band || errors.is_some() { span.key-band {} " legal  " }
                @if has_mistake { span.key-mistaken {} " with the mistake  " }
                @if value.is_some() { span.key-value {} " the answer  " }
                @if !has_band { div.quiet { "What is legal is narrower than the line." } }
            }
            (held(course))
        }
    }
}

/// The inputs that are the same at each point, each with its numbers together.
fn held(course: &OutputCourse) -> Markup {
    let mut inputs: Vec<(&str, Vec<String>, Option<&str>)> = vec![];
    for one in &course.held {
        let name = one.name.split('.').next().unwrap_or_default();
        match inputs.last_mut().filter(|(last, ..)| *last == name) {
            Some((_, numbers, _)) => numbers.push(short(one.value.0)),
            None => inputs.push((name, vec![short(one.value.0)], one.unit.as_deref())),
        }
    }
    let written = |(name, numbers, unit): (&str, Vec<String>, Option<&str>)| {
        let value = if let [one] = numbers.as_slice() { one.clone() } else { format!("({})", numbers.join(", ")) };
        match unit.filter(|unit| !matches!(*unit, "1" | "color")) {
            Some(unit) => format!("{name} = {value} {unit}"),
            None => format!("{name} = {value}"),
        }
    };
    let written: Vec<String> = inputs.into_iter().map(written).collect();
    html! { @if !written.is_empty() {
        details.held { summary { "The other inputs, which are the same at each point" } p { (written.join("; ")) } }
    } }
}

/// Whether the legal values are wide enough somewhere to be seen.
fn is_band_seen(course: &OutputCourse, axis: &Axis) -> bool {
    const LEAST_PIXELS: f64 = 0.5;
    let height = |point: &CoursePoint| (axis.y(point.interval[0].0) - axis.y(point.interval[1].0)).abs();
    course.points.iter().map(height).any(|pixels| pixels >= LEAST_PIXELS)
}

/// The legal values as an area.
fn band(course: &OutputCourse, axis: &Axis) -> String {
    let is_told = |point: &&CoursePoint| point.interval.iter().all(|x| x.0.is_finite());
    let told: Vec<&CoursePoint> = course.points.iter().filter(is_told).collect();
    let up = told.iter().map(|point| (across(course, point.x.0), axis.y(point.interval[1].0)));
    let down = told.iter().rev().map(|point| (across(course, point.x.0), axis.y(point.interval[0].0)));
    let area = path(up.chain(down));
    if area.is_empty() { area } else { area + "Z" }
}

/// The lower panel: its axis, the legal band, the mistake's path and the answer's height; `None` where nothing departs.
fn errors_of(course: &OutputCourse, value: Option<f64>) -> Option<(Axis, String, String, Option<f64>)> {
    let margins: Vec<(f64, f64)> = course
        .points
        .iter()
        .map(|point| (point.x.0, point.mistaken.map_or(f64::NAN, |made| folded(margin(point, made.0)))))
        .collect();
    let at = course.points.iter().find(|point| point.x.0.to_bits() == course.at.0.to_bits());
    let own = at.zip(value).map(|(point, value)| folded(margin(point, value))).filter(|x| !x.is_nan());
    let all = margins.iter().map(|(_, margin)| *margin).chain(own).chain([-1.5, 1.5]);
    if own.is_none() && margins.iter().all(|(_, margin)| margin.is_nan()) {
        return None;
    }
    let axis = Axis::of(all, AROUND + HEIGHT + 30.0)?;
    let (left, right) = (LEFT, WIDTH - AROUND);
    let (upper, lower) = (axis.y(1.0), axis.y(-1.0));
    let band = format!("M{left} {upper:.1}L{right} {upper:.1}L{right} {lower:.1}L{left} {lower:.1}Z");
    let path = path(margins.into_iter().map(|(x, margin)| (across(course, x), axis.y(margin))));
    let dot = own.map(|own| axis.y(own));
    Some((axis, band, path, dot))
}

/// The margins that are written beside an axis: 0, and to each side the end of what is legal, or the whole power of ten that is next to the end of
/// the axis.
fn margin_ticks(axis: &Axis) -> [f64; 3] {
    let end = |folded: f64| if folded.abs() < 2.0 { 1.0_f64.copysign(folded) } else { folded.trunc() };
    [end(axis.values[0]), 0.0, end(axis.values[1])]
}

/// A folded margin as it is written. The greatest stands for all beyond it.
fn unfolded(folded: f64) -> String {
    let size = folded.abs();
    let written = match size - 1.0 {
        power if power <= 0.0 => short(size),
        power => {
            #[expect(clippy::cast_possible_truncation, reason = "at most eight")]
            let raised = superscript(power.min(MOST_POWER).round() as i32);
            if power >= MOST_POWER { format!("≥ 10{raised}") } else { format!("10{raised}") }
        }
    };
    if folded < 0.0 && size > 0.0 { format!("−{written}") } else { written }
}

/// The margins beside an axis from 0: the end of what is legal, and the power of ten at the end of the axis, where it goes beyond the first.
fn tolerances(most: f64) -> Vec<f64> {
    if most < 2.0 { vec![0.0, 1.0] } else { vec![0.0, 1.0, most] }
}

fn frame(top: f64) -> Markup {
    html! { rect.frame x=(LEFT) y=(top) width=(WIDTH - LEFT - AROUND) height=(HEIGHT) {} }
}

fn ticks(axis: &Axis, values: &[f64], written: fn(f64) -> String) -> Markup {
    html! {
        @for value in values {
            text.tick x=(LEFT - 6.0) y=(axis.y(*value).clamp(axis.top + 8.0, axis.top + HEIGHT)) text-anchor="end" { (written(*value)) }
        }
    }
}

/// How large errors are along the input of a sweep.
pub(super) fn errors(document: &SweepDocument) -> Markup {
    let sweep = &document.sweep;
    let along = &document.statistics.along;
    let most = along.iter().map(|part| part.error_max.0).filter(|x| x.is_finite()).fold(0.0, f64::max);
    if along.is_empty() {
        return html! {};
    }
    let parts = along.iter().map(|part| part.part + 1).max().unwrap_or(1).max(256);
    #[expect(clippy::cast_precision_loss, reason = "parts of a sweep")]
    let x = |part: usize| LEFT + (WIDTH - LEFT - AROUND) * part as f64 / parts as f64;
    let most = if most > 0.0 { most } else { 1.0 };
    let axis = Axis { values: [0.0, most], least: 0.0, most, top: AROUND };
    let height = |error: f64| if error.is_finite() { AROUND + HEIGHT - axis.y(error) } else { HEIGHT };
    // The legal band goes up to a margin of 1.
    let margin = |part: &SweepPart| folded(part.margin_max.0).min(1.0 + MOST_POWER);
    let most = along.iter().map(margin).filter(|x| x.is_finite()).fold(1.2, f64::max);
    let margins = Axis { values: [0.0, most], least: 0.0, most, top: AROUND + HEIGHT + 18.0 };
    let bottom = margins.top + HEIGHT;
    let has_margins = along.iter().any(|part| part.margin_max.0 > 0.0);
    let whole = if has_margins { bottom } else { AROUND + HEIGHT };
    html! {
        figure.plot {
            svg viewBox={ "0 0 " (WIDTH) " " (whole + 46.0) } role="img" aria-label={ "errors of " (sweep.formula) " along " (sweep.over) } {
                (ticks(&axis, &[0.0, axis.most / 2.0, axis.most], short))
                (frame(AROUND))
                // A block of inputs is told where it begins, and of a short sweep there are fewer blocks than parts.
                @for (k, part) in along.iter().enumerate() {
                    @let end = along.get(k + 1).map_or(parts, |next| next.part);
                    rect class=(if part.failed > 0 { "bar fails" } else { "bar" }) x=(format!("{:.1}", x(part.part))) y=(format!("{:.1}", AROUND + HEIGHT - height(part.error_max.0)))
                        width=(format!("{:.2}", (x(end) - x(part.part)).max(0.8))) height=(format!("{:.1}", height(part.error_max.0).max(0.0))) {}
                }
                text.name x=(LEFT + 6.0) y=(AROUND - 3.0) { "greatest error, " (sweep.unit) }
                @if has_margins {
                    (ticks(&margins, &tolerances(margins.most), unfolded))
                    (frame(margins.top))
                    rect.band x=(LEFT) width=(WIDTH - LEFT - AROUND) y=(format!("{:.1}", margins.y(1.0))) height=(format!("{:.1}", bottom - margins.y(1.0))) {}
                    @for (k, part) in along.iter().enumerate().filter(|(_, part)| margin(part).is_finite()) {
                        @let end = along.get(k + 1).map_or(parts, |next| next.part);
                        line class=(if part.failed > 0 { "level fails" } else { "level" }) x1=(format!("{:.1}", x(part.part))) x2=(format!("{:.1}", x(end).max(x(part.part) + 0.8)))
                            y1=(format!("{:.1}", margins.y(margin(part)))) y2=(format!("{:.1}", margins.y(margin(part)))) {}
                    }
                    text.name x=(LEFT + 6.0) y=(margins.top - 4.0) { "error over tolerance" }
                }
                @for (place, anchor, end) in [(0.0, "start", &sweep.from), (1.0, "end", &sweep.to)] {
                    @if let Some(end) = end { text.tick x=(LEFT + (WIDTH - LEFT - AROUND) * place) y=(whole + 18.0) text-anchor=(anchor) { (end.0) } }
                }
                text.name x=(f64::midpoint(LEFT, WIDTH)) y=(whole + 36.0) text-anchor="middle" { (sweep.over) ", float by float" }
            }
            figcaption { (sweep.formula) ": errors of " (sweep.output) " along " (sweep.over) "; parts in which a value is not legal are red. " @if has_margins { span.key-band {} " legal" } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_document::Number;
    use lightmeter_document::explained::HeldNumber;

    fn point(x: f64, reference: f64, reach: f64) -> CoursePoint {
        let interval = [Number(reference - reach), Number(reference + reach)];
        CoursePoint { x: Number(x), reference: Number(reference), interval, mistaken: None }
    }

    fn plotted(reach: f64) -> OutputCourse {
        let held =
            |name: &str, value| HeldNumber { name: name.into(), value: Number(value), unit: Some("unit".into()) };
        OutputCourse {
            input: "density".into(),
            unit: None,
            output: "f".into(),
            at: Number(0.5),
            held: vec![held("p.x", -1.0), held("p.y", 0.25), held("fog", 3.0)],
            is_logarithmic: false,
            points: (0..5).map(|k| point(f64::from(k), f64::from(k) / 4.0, reach)).collect(),
        }
    }

    #[test]
    fn a_plot_tells_the_inputs_that_it_holds_and_what_is_legal_where_that_is_seen() {
        let html = course(&plotted(0.1), None).0;
        assert!(html.contains("p = (−1, 0.25) unit; fog = 3 unit"), "{html}");
        assert!(html.contains("legal  ") && !html.contains("narrower"), "{html}");
        let narrow = course(&plotted(1e-9), None).0;
        assert!(narrow.contains("narrower than the line") && !narrow.contains("legal  "), "{narrow}");
    }

    #[test]
    fn an_axis_has_room_for_what_is_legal_and_is_marked_at_its_values() {
        let axis = Axis::with_band(&plotted(0.1), None).expect("it has values");
        assert!(axis.least <= -0.1 && axis.most >= 1.1, "{} to {}", axis.least, axis.most);
        let wide = Axis::with_band(&plotted(100.0), None).expect("it has values");
        assert_eq!(wide.values.map(short), ["0", "1"]);
        assert_eq!(wide.ticks().into_iter().map(short).collect::<Vec<_>>(), ["0", "0.5", "1"]);
    }

    #[test]
    fn errors_over_tolerance_are_written_as_they_are() {
        let axis = |values| Axis { values, least: values[0], most: values[1], top: 0.0 };
        let written = |values| margin_ticks(&axis(values)).map(unfolded);
        assert_eq!(written([-1.5, 1.5]), ["−1", "0", "1"]);
        assert_eq!(written([-1.5, 4.6]), ["−1", "0", "10³"]);
        assert_eq!(written([-3.0, 1.0 + MOST_POWER]), ["−10²", "0", "≥ 10⁸"]);
        let beside = |most| tolerances(most).into_iter().map(unfolded).collect::<Vec<_>>();
        assert_eq!(
            (beside(1.2), beside(4.0)),
            (vec!["0".into(), "1".into()], vec!["0".into(), "1".into(), "10³".into()])
        );
    }
}
