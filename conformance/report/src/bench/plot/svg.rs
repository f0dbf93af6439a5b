//! Pieces that all pictures are made of.

use super::axis::{Axis, ErrorAxis, tick};
use super::label::{Area, MUST, Room};
use super::mark::{Style, mark};
use std::fmt::{Result, Write};

/// Pixels across: what a page has room for.
pub(super) const WIDTH: f64 = 900.0;
/// Pixels of text.
pub(super) const SIZE: f64 = 13.0;
const SMALL: f64 = 12.0;

pub(super) fn open(height: f64, title: &str, below: &str, out: &mut impl Write) -> Result {
    writeln!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" font-size="{SIZE}">
<rect width="100%" height="100%" fill="#ffffff"/>
<text x="12" y="24" font-size="16" font-weight="bold">{}</text>
<text x="12" y="44" fill="#444444">{}</text>"##,
        escaped(title),
        escaped(below)
    )
}

/// Text from its left end, middle or right end (`start`, `middle`, `end`).
pub(super) fn text([x, y]: [f64; 2], anchor: &str, small: bool, words: &str, out: &mut impl Write) -> Result {
    let (size, words) = (if small { SMALL } else { SIZE }, escaped(words));
    writeln!(out, r#"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}" font-size="{size}">{words}</text>"#)
}

/// What an axis is of, upward along the left side.
pub(super) fn upward([x, y]: [f64; 2], words: &str, out: &mut impl Write) -> Result {
    writeln!(
        out,
        r#"<text transform="translate({x:.1},{y:.1}) rotate(-90)" text-anchor="middle">{}</text>"#,
        escaped(words)
    )
}

/// Lines and figures of the axis along the bottom.
pub(super) fn across(x: &Axis, [top, bottom]: [f64; 2], ticks: usize, scale: f64, out: &mut impl Write) -> Result {
    for value in x.ticks(ticks) {
        let at = x.at(value);
        writeln!(out, r##"<path d="M{at:.1} {top:.1}V{bottom:.1}" stroke="#e4e4e4"/>"##)?;
        text([at, bottom + 16.0], "middle", true, &tick(rounded(value / scale)), out)?;
    }
    Ok(())
}

/// A round value that was scaled is round again.
fn rounded(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

/// Lines and figures of a plain axis upward.
pub(super) fn up(y: &Axis, [left, right]: [f64; 2], ticks: usize, scale: f64, out: &mut impl Write) -> Result {
    for value in y.ticks(ticks) {
        let at = y.at(value);
        writeln!(out, r##"<path d="M{left:.1} {at:.1}H{right:.1}" stroke="#e4e4e4"/>"##)?;
        text([left - 6.0, at + 4.0], "end", true, &tick(rounded(value / scale)), out)?;
    }
    Ok(())
}

/// The axis of errors, with its bands.
pub(super) fn errors(y: &ErrorAxis, [left, right]: [f64; 2], ticks: usize, out: &mut impl Write) -> Result {
    for (middle, name) in [(y.zero, "0"), (y.infinite, "∞")] {
        let Some(middle) = middle else { continue };
        writeln!(
            out,
            r##"<rect x="{left:.1}" y="{:.1}" width="{:.1}" height="{:.1}" fill="#f0f0f0"/>"##,
            middle - y.half,
            right - left,
            2.0 * y.half
        )?;
        text([left - 6.0, middle + 4.0], "end", false, name, out)?;
    }
    up(&y.axis, [left, right], ticks, 1.0, out)
}

pub(super) fn frame(area: Area, out: &mut impl Write) -> Result {
    let Area { left, top, width, height } = area;
    writeln!(
        out,
        r##"<rect x="{left:.1}" y="{top:.1}" width="{width:.1}" height="{height:.1}" fill="none" stroke="#999999"/>"##
    )
}

/// A marker with a name.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub(super) name: String,
    pub(super) at: [f64; 2],
    pub(super) r: f64,
    pub(super) style: Style,
    /// On the front: its place there.
    pub(super) front: Option<usize>,
    /// Wrong in value.
    pub(super) is_hollow: bool,
}

/// The line of the front, the markers upon it, and all names.
pub(super) fn markers(named: &[Named], mut room: Room, out: &mut impl Write) -> Result {
    let named = told_apart(named);
    let mut front: Vec<&Named> = named.iter().filter(|one| one.front.is_some()).collect();
    front.sort_by_key(|one| one.front);
    for pair in front.windows(2) {
        let ([x, y], [to_x, to_y]) = (pair[0].at, pair[1].at);
        writeln!(out, r##"<path d="M{x:.1} {y:.1}L{to_x:.1} {to_y:.1}" stroke="#333333" stroke-width="1.6"/>"##)?;
        room.take_line(pair[0].at, pair[1].at, 2.0);
    }
    for one in &named {
        room.take(Area::around(one.at, one.r + 2.0), MUST);
    }
    let others = named.iter().filter(|one| one.front.is_none());
    let mut names = vec![];
    for one in front.iter().copied().chain(others).filter(|one| !one.name.is_empty()) {
        let width = text_width(&one.name, SIZE) * if one.front.is_some() { 1.1 } else { 1.0 };
        let put = room.put(one.at, one.r, [width, SIZE + 2.0]);
        if let Some([x, y]) = put.leader {
            let [from_x, from_y] = one.at;
            writeln!(
                out,
                r##"<path d="M{from_x:.1} {from_y:.1}L{x:.1} {y:.1}" stroke="#999999" stroke-width="0.8"/>"##
            )?;
        }
        names.push((one, put.area));
    }
    for one in &named {
        mark(one.style, one.at, one.r, one.is_hollow, out)?;
    }
    for (one, area) in names {
        let weight = if one.front.is_some() { r#" font-weight="bold""# } else { "" };
        let fill = if one.front.is_some() { "#000000" } else { "#444444" };
        writeln!(
            out,
            r##"<text x="{:.1}" y="{:.1}" text-anchor="middle" fill="{fill}"{weight} stroke="#ffffff" stroke-width="3" stroke-opacity="0.85" paint-order="stroke">{}</text>"##,
            area.left + area.width / 2.0,
            area.top + SIZE - 1.5,
            escaped(&one.name)
        )?;
    }
    Ok(())
}

/// Markers of which those that others lie upon are larger, so that they still show.
fn told_apart(named: &[Named]) -> Vec<Named> {
    let of = |(place, one): (usize, &Named)| {
        let is_upon = |other: &&Named| (other.at[0] - one.at[0]).hypot(other.at[1] - one.at[1]) < 0.8 * one.r;
        let upon = named[place + 1..].iter().filter(is_upon).map(|_| 1.0).sum::<f64>();
        Named { r: one.r * (1.0 + 0.4 * upon.min(6.0)), ..one.clone() }
    };
    named.iter().enumerate().map(of).collect()
}

/// The pixels that text takes at most, in the fonts that browsers have for `sans-serif`.
pub(super) fn text_width(words: &str, size: f64) -> f64 {
    let wide = |letter: char| match letter {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | ' ' | 'f' | 't' | '(' | ')' | '/' | 'r' | '-' => 0.4,
        'm' | 'w' | 'M' | 'W' => 0.95,
        letter if letter.is_uppercase() => 0.72,
        _ => 0.62,
    };
    size * words.chars().map(wide).sum::<f64>()
}

/// As many words as have room, and a mark where some have not.
pub(super) fn shortened(words: &str, size: f64, width: f64) -> String {
    if text_width(words, size) <= width {
        return words.to_owned();
    }
    let mut kept = String::new();
    for word in words.split_whitespace() {
        if text_width(&kept, size) + text_width(word, size) + 2.0 * size > width {
            break;
        }
        kept.push_str(word);
        kept.push(' ');
    }
    kept.trim_end_matches([' ', ',', ';', ':']).to_owned() + " …"
}

pub(super) fn escaped(words: &str) -> String {
    words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::super::mark::style;
    use super::*;

    #[test]
    fn markers_on_each_other_all_show() {
        let named = |name: &str, x: f64| Named {
            name: name.into(),
            at: [x, 10.0],
            r: 6.0,
            style: style(name, 0),
            front: None,
            is_hollow: false,
        };
        let sizes: Vec<f64> = told_apart(&[named("a", 10.0), named("b", 11.0), named("c", 10.0), named("d", 40.0)])
            .iter()
            .map(|one| one.r)
            .collect();
        assert!(sizes[0] > sizes[1] && sizes[1] > sizes[2], "{sizes:?}");
        assert_eq!([sizes[2], sizes[3]].map(f64::to_bits), [6.0, 6.0].map(f64::to_bits));
    }

    #[test]
    fn long_words_are_cut_between_words() {
        assert_eq!(shortened("short", SIZE, 400.0), "short");
        let cut = shortened(&"several words, ".repeat(20), SIZE, 200.0);
        assert!(cut.ends_with(" …") && text_width(&cut, SIZE) <= 200.0 && !cut.contains(", …"), "{cut}");
        assert_eq!(escaped("a<b & |\"v\"|>"), "a&lt;b &amp; |&quot;v&quot;|&gt;");
    }
}
