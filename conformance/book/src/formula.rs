//! The page of a formula: what it computes, how it looks, who computes it otherwise, how accurate it is, and how it is got wrong.

use crate::apart::apart;
use crate::contents::Place;
use crate::diagram::diagram;
use crate::errors::{CASES, errors};
use crate::grid::{grid, plain};
use crate::picture::FormulaPicture;
use crate::rule::rule;
use crate::sketch::{short, sketch};
use lightmeter_arithmetic::profile::WGSL;
use lightmeter_catalogue::cases::blend::COMMON;
use lightmeter_catalogue::cases::{DRAWN, Kind, Spec, boundary_names};
use lightmeter_catalogue::dialects::{DIALECTS, DialectForm, Dialects};
use lightmeter_catalogue::rulings::RULINGS;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::mistakes::MistakeLook;
use lightmeter_document::thousands;
use lightmeter_faults::{Fault, Variation, listed, look, typical_course};
use lightmeter_gpu::Shaders;
use lightmeter_report::html::{course_plot, equation, prose, written};
use maud::{Markup, html};
use std::collections::HashSet;

/// Mistakes that a page shows at once; the others are folded.
const SHOWN: usize = 8;

/// What the page of a formula is made of.
pub(crate) struct FormulaPage<'a> {
    /// The formula.
    pub(crate) member: &'a Member,
    /// All formulas.
    pub(crate) catalogue: &'a [Member],
    /// The WGSL.
    pub(crate) shaders: &'a Shaders,
    /// Where the page is, for its links.
    pub(crate) place: Place<'a>,
}

impl FormulaPage<'_> {
    /// All of the page but its frame.
    pub(crate) fn body(&self) -> Markup {
        let spec = &self.member.spec;
        let picture = FormulaPicture::of(self.member);
        html! {
            h1 { code { (spec.id) } }
            (self.statement())
            (diagram(spec))
            h2 #values { "What goes in, what comes out" }
            (self.values())
            (self.course())
            @if let Some(picture) = &picture {
                figure.picture { (picture.img(self.member)) figcaption { (picture.caption(self.member)) } }
            }
            (self.dialects())
            (self.code())
            (self.accuracy())
            (self.stable())
            (self.hard())
            (self.mistakes(picture.as_ref()))
            (self.commands())
        }
    }

    pub(crate) fn statement(&self) -> Markup {
        let spec = &self.member.spec;
        let rules = spec.rules();
        html! {
            (set_equation(spec))
            @if !rules.is_empty() {
                p { "What the line does not say:" }
                ul.rules { @for rule in &rules { li { (prose(rule)) } } }
            }
            p.quiet {
                "Source: " (self.source(spec.source))
                @if let Some((file, title)) = chapter(spec) { ". Read about it: " a href=(self.place.to(file)) { (title) } }
            }
        }
    }

    /// A source, with links to the rulings that it names.
    fn source(&self, text: &str) -> Markup {
        html! {
            @for (k, part) in text.split("; ").enumerate() {
                @if k > 0 { "; " }
                @let numbers: Vec<u32> = part.strip_prefix("ruling").into_iter().flat_map(|rest| rest.split(|c: char| !c.is_ascii_digit())).filter_map(|word| word.parse().ok()).collect();
                @match numbers.first() {
                    Some(number) => a href={ (self.place.to("rulings.html")) "#ruling-" (number) } { (prose(part)) },
                    None => (prose(part)),
                }
            }
        }
    }

    pub(crate) fn values(&self) -> Markup {
        let spec = &self.member.spec;
        html! {
            div.wide tabindex="0" role="group" aria-label="inputs and outputs" { table {
                thead { tr { th scope="col" { "value" } th scope="col" { "shape" } th scope="col" { "unit" } th scope="col" { "meaning" } th scope="col" { "random cases draw" } } }
                tbody {
                    @for input in spec.inputs { tr { th scope="row" { code { (input.name) } } td { (input.shape.name()) } td { (unit(input.unit)) } td { (prose(spec.input_means(input))) } td { (written(&input.domain.to_string())) } } }
                    @for output in spec.outputs { tr { th scope="row" { "→ " code { (output.name) } } td { (output.shape.name()) } td { (unit(output.unit)) } td { (prose(spec.output_means(output))) } td {} } }
                }
            } }
        }
    }

    /// An output along the input on which it varies most.
    pub(crate) fn course(&self) -> Markup {
        let plain = plain(self.member);
        let course = if plain.is_some() { None } else { typical_course(self.member, &WGSL) };
        html! {
            @if plain.is_some() || course.is_some() { h2 #course { "How it looks" } }
            @if let Some(plain) = &plain { (plain.svg()) }
            @if let Some(course) = &course { (course_plot(course, None)) }
        }
    }

    pub(crate) fn dialects(&self) -> Markup {
        let told: Vec<&Dialects> = DIALECTS.iter().filter(|one| one.concern(&self.member.spec.id)).collect();
        html! {
            @if !told.is_empty() {
                h2 #dialects { "Who computes what" }
                @for one in told { (dialect(one, &self.place, self.catalogue)) }
            }
        }
    }

    pub(crate) fn code(&self) -> Markup {
        let spec = &self.member.spec;
        let file = spec.file();
        let text = if spec.function.is_empty() { None } else { self.shaders.function_with_named(&file, spec.function) };
        html! {
            @if let Some(text) = text {
                h2 #wgsl { "In WGSL" }
                p { "The function that is judged, from " code { (file) } ", and what it names. The reference is a second text of the same formula, in Rust, and shares nothing with it." }
                pre tabindex="0" { code { (text) } }
            }
        }
    }

    pub(crate) fn accuracy(&self) -> Markup {
        let found = errors(self.member);
        html! {
            @if !found.is_empty() {
                h2 #accuracy { "How accurate it is in 32 bits" }
                p {
                    "Computed in binary32 as it is written, each operation rounded once, at " (thousands(CASES)) " random cases"
                    @if !self.member.spec.hard.is_empty() { " and at the hard cases with what lies near them" }
                    ". Errors are in ULP of binary32. “Legal” is how far WGSL's rules permit a result to be from the exact one."
                }
                div.wide tabindex="0" role="group" aria-label="errors" { table {
                    thead { tr {
                        th scope="col" { "output" } th scope="col" { "greatest error, random" }
                        @if !self.member.spec.hard.is_empty() { th scope="col" { "greatest error, hard" } }
                        th scope="col" { "legal up to, random" } th scope="col" { "cases where any value is legal" } th scope="col" { "condition number, median" }
                    } }
                    tbody { @for one in &found { tr {
                        th scope="row" { code { (one.name) } }
                        td.right { (ulp(one.random)) }
                        @if let Some(hard) = one.hard { td.right { (ulp(hard)) } }
                        td.right { (ulp(one.legal)) } td.right { (percent(one.anything)) } td.right { (ulp(one.condition)) }
                    } } }
                } }
                p.hint { a href=(self.place.to("floats-and-what-is-legal.html")) { "Floats, ULP, and what is legal" } " says what these numbers mean, " a href=(self.place.to("condition-and-stability.html")) { "Condition and stability" } " what the condition number does." }
            }
        }
    }

    pub(crate) fn stable(&self) -> Markup {
        let spec = &self.member.spec;
        let better: Vec<(&Spec, &str, &str)> = self
            .catalogue
            .iter()
            .flat_map(|member| member.spec.hard.iter().map(move |hard| (&member.spec, hard)))
            .filter_map(|(of, hard)| Some((of, hard.name, hard.naive.filter(|naive| naive.formula == spec.id)?.fails)))
            .collect();
        html! {
            @if spec.stable.is_some() || !better.is_empty() {
                h2 #stable { "The stable form" }
                @if let Some(stable) = spec.stable {
                    p { "This is a stable form. At its hard cases and near them it errs by at most " (written(&stable.bound.to_string())) " roundings: " (stable.because) "." }
                }
                @if !better.is_empty() {
                    p { "This form fails where another one does not:" }
                    ul { @for (of, case, fails) in &better { li { "At the hard case " code { (case) } " of " (self.link(&of.id)) ", which is right there: " (prose(fails)) "." } } }
                }
            }
        }
    }

    pub(crate) fn hard(&self) -> Markup {
        let (member, spec) = (self.member, &self.member.spec);
        let boundaries = boundary_names(spec);
        let rows = spec.hard.iter().enumerate().map(|(place, hard)| {
            let mut row = vec![];
            member.inputs(CaseRef::Hard(place), 1, &mut row);
            let mut reference = vec![0.0; spec.output_len()];
            member.formula.reference(&row, &mut reference);
            (hard, reference)
        });
        html! {
            @if !spec.hard.is_empty() {
                h2 #hard { "Hard cases" }
                div.wide tabindex="0" role="group" aria-label="hard cases" { table {
                    thead { tr { th scope="col" { "case" } th scope="col" { "what it holds" } th scope="col" { "inputs that are given" } th scope="col" { "exact result" } th scope="col" { "who fails there" } } }
                    tbody { @for (hard, reference) in rows { tr {
                        th scope="row" { code { (hard.name) } }
                        td { (prose(hard.pins)) }
                        td { @for (name, values) in hard.inputs { div { code { (name) " = " (list(values.iter().map(|&x| f64::from(x)))) } } } }
                        td { @for (output, values) in outputs(spec, &reference) { div { code { (output) " = " (list(values.iter().copied())) } } } }
                        td { @if let Some(naive) = hard.naive { (self.link(naive.formula)) ": " (prose(naive.fails)) } }
                    } } }
                } }
            }
            @if !boundaries.is_empty() {
                h2 #boundaries { "Close to where it decides" }
                p { (thousands(DRAWN)) " cases each come close to a place where the formula decides something or degenerates: at distances from ½ to 2⁻²⁴, at a distance of 0, and together with another of these: " }
                p { @for (k, name) in boundaries.iter().enumerate() { @if k > 0 { " · " } (name) } }
            }
        }
    }

    pub(crate) fn mistakes(&self, picture: Option<&FormulaPicture>) -> Markup {
        let faults = listed(self.member);
        let is_drawn = matches!(self.member.spec.kind, Kind::Raster(_) | Kind::Depth(_));
        let mut shown = HashSet::new();
        let sections: Vec<Markup> = faults.iter().map(|fault| self.mistake(fault, picture, &mut shown)).collect();
        html! {
            @if !faults.is_empty() {
                h2 #mistakes { "How it is got wrong" }
                p {
                    @if faults.len() == 1 { "One mistake that renderers make is known by name in this formula. " }
                    @else { (faults.len()) " mistakes that renderers make are known by name in this formula. The suite tells them from each other by what they give. " }
                    @if is_drawn { "On the left is what is right, on the right what the mistake makes of it; in a plot the solid and the dashed line." }
                    @else { "The solid line is what is right, the dashed one what the mistake makes of it." }
                }
                div.mistakes { @for section in sections.iter().take(SHOWN) { (section) } }
                @if sections.len() > SHOWN {
                    details.section {
                        summary { (sections.len() - SHOWN) " more" }
                        div.mistakes { @for section in &sections[SHOWN..] { (section) } }
                    }
                }
            }
        }
    }

    fn mistake(
        &self,
        fault: &'static Fault,
        picture: Option<&FormulaPicture>,
        shown: &mut HashSet<Vec<i32>>,
    ) -> Markup {
        let Some(variation) = Variation::new(self.member, &[fault]) else { return html! {} };
        let grid = grid(self.member, &variation);
        let plot = if grid.is_some() { None } else { sketch(self.member, &variation, shown) };
        let picture = picture.and_then(|picture| picture.img_with(self.member, &variation));
        let look = look(self.member, fault);
        html! {
            section.mistake id={ "mistake-" (fault.name) } {
                h3 { code { (fault.name) } }
                p { (prose(&sentence(fault.says))) @if let Some(seen) = fault.seen_in { span.quiet { " Seen in: " (seen) "." } } }
                @if let Some(look) = &look { p.hint { (looks(look)) } }
                div.pictures {
                    @if let Some(picture) = &picture { figure.picture { (picture) } }
                    @if let Some(grid) = &grid { (grid.svg()) }
                    @if let Some(plot) = &plot { (plot.svg()) }
                }
                @if grid.is_none() && plot.is_none() && picture.is_none() {
                    @if let Some(apart) = apart(self.member, &variation) { (apart.html()) }
                }
            }
        }
    }

    pub(crate) fn commands(&self) -> Markup {
        let spec = &self.member.spec;
        let case = spec
            .hard
            .first()
            .map_or_else(|| self.member.case_id(CaseRef::Random(0)), |_| self.member.case_id(CaseRef::Hard(0)));
        html! {
            h2 #commands { "Look further" }
            pre tabindex="0" { code {
                "lightmeter run '" (spec.id) "'\n"
                "lightmeter show " (case) "\n"
                @if matches!(spec.kind, Kind::Arithmetic) { "lightmeter bench " (spec.id) "\n" }
            } }
            @for common in COMMON.iter().filter(|common| common.id == spec.id) { p { "It is used for: " (common.what) "." } }
        }
    }

    pub(crate) fn link(&self, id: &str) -> Markup {
        link(id, &self.place, self.catalogue)
    }
}

/// A formula's name, as a link where it has a page.
pub(crate) fn link(id: &str, place: &Place<'_>, catalogue: &[Member]) -> Markup {
    let member = catalogue.iter().find(|member| member.spec.id == id);
    html! { @match member.and_then(|member| page_of(&member.spec)) {
        Some(page) => a href=(place.to(&page)) { code { (id) } },
        None => code { (id) },
    } }
}

/// The address of the page that a formula is told on; `None` of a blend state, which the pages of its equation and factors tell.
pub(crate) fn page_of(spec: &Spec) -> Option<String> {
    let of_group = ["blend/write-mask", "blend/without-alpha", "blend/layers"];
    if of_group.contains(&spec.group()) {
        return Some(format!("formula/{}.html", spec.group()));
    }
    let is_told_elsewhere = spec.id.matches('/').count() > 1 && spec.family() == "blend";
    if is_told_elsewhere {
        return None;
    }
    match spec.id.strip_prefix("blend/mode-") {
        Some(mode) => Some(format!("blend/mode/{mode}.html")),
        None => Some(format!("formula/{}.html", spec.id)),
    }
}

/// A page of a formula, and what is told on it.
pub(crate) struct Told<'a> {
    /// Its address.
    pub(crate) path: String,
    /// The formula that it is about: of several on one page the one with the most mistakes.
    pub(crate) member: &'a Member,
    /// The others on the same page.
    pub(crate) others: Vec<&'a Member>,
}

/// All pages of formulas, in the order of the catalogue.
pub(crate) fn told<'a>(catalogue: &'a [Member]) -> Vec<Told<'a>> {
    let mut pages: Vec<(String, Vec<&'a Member>)> = vec![];
    for member in catalogue {
        let Some(path) = page_of(&member.spec) else { continue };
        match pages.iter_mut().find(|(own, _)| *own == path) {
            Some((_, members)) => members.push(member),
            None => pages.push((path, vec![member])),
        }
    }
    let page = |(path, members): (String, Vec<&'a Member>)| {
        let told =
            (0..members.len()).rev().max_by_key(|&k| if members.len() > 1 { listed(members[k]).len() } else { 0 });
        let member = members[told.unwrap_or_default()];
        let others = members.iter().copied().filter(|other| other.spec.id != member.spec.id).collect();
        Told { path, member, others }
    };
    pages.into_iter().map(page).collect()
}

/// The chapter that explains a formula of its kind, and its title.
fn chapter(spec: &Spec) -> Option<(&'static str, &'static str)> {
    let is_of = |ids: &[&str]| ids.iter().any(|id| spec.id.starts_with(id));
    if is_of(&["lighting/gouraud", "lighting/phong-shading", "lighting/phong-interpolated", "lighting/flat"]) {
        Some(("gouraud-and-highlights.html", "Gouraud shading and its highlights"))
    } else if matches!(spec.kind, Kind::Raster(_)) || is_of(&["interpolation/coverage"]) {
        Some(("a-rasterisers-freedom.html", "A rasteriser's freedom"))
    } else if spec.stable.is_some() {
        Some(("condition-and-stability.html", "Condition and stability"))
    } else {
        None
    }
}

/// Words that make a line a sentence.
const ORDINARY: [&str; 19] = [
    "the", "of", "is", "with", "it", "by", "as", "how", "that", "which", "in", "on", "and", "its", "against", "passes",
    "where", "if", "else",
];
/// Signs of which an equation has one at least.
const OPERATORS: &str = "=·⟨√^+|Σ×/";

/// How many words of a sentence a line has.
fn ordinary(text: &str) -> usize {
    text.split(|c: char| !c.is_alphabetic()).filter(|word| ORDINARY.contains(word)).count()
}

/// Whether the formula on a line is a sentence, or mostly one: as mathematics it would be hard to read.
fn is_sentence(text: &str) -> bool {
    const LEAST: usize = 3;
    let words = ordinary(text);
    words >= LEAST || words > 0 && !text.contains(|c| OPERATORS.contains(c))
}

/// The equation at the beginning of a line that is a sentence otherwise, and the rest: `color = max(src, dst)` and `, with the factors …`.
fn split_equation(text: &str) -> Option<(&str, &str)> {
    let (mut depth, mut start, mut end) = (0_i32, 0, None);
    let is_equation = |part: &str| part.contains(|c| OPERATORS.contains(c)) && ordinary(part) == 0;
    for (at, c) in text.char_indices() {
        depth += match c {
            '(' | '[' | '⟨' => 1,
            ')' | ']' | '⟩' => -1,
            _ => 0,
        };
        let ends =
            [", ", "; ", " where ", " with ", " of ", " as "].into_iter().find(|end| text[at..].starts_with(end));
        let Some(separator) = ends.filter(|_| depth == 0 && at >= start) else { continue };
        if !is_equation(&text[start..at]) {
            break;
        }
        end = Some(at);
        start = at + separator.len();
    }
    end.map(|end| text.split_at(end))
}

/// The formula as mathematics, a line for each of its statements, and as it stands in reports; a sentence as it is, below the equation that it
/// begins with.
pub(crate) fn set_equation(spec: &Spec) -> Markup {
    let (line, says) = if is_sentence(spec.text) {
        match split_equation(spec.text) {
            Some(parts) => parts,
            None => {
                return html! {
                    @if let Some(rule) = rule(&spec.id) { (set_lines(spec, &rule)) }
                    p.equation.said { (prose(spec.text)) }
                };
            }
        }
    } else {
        (spec.text, "")
    };
    html! {
        (set_lines(spec, line))
        @if !says.is_empty() { p { "… " (prose(says.trim_start_matches([',', ';', ' ']))) "." } }
        p.quiet { "As reports write it: " code { (spec.text) } }
    }
}

/// Statements as mathematics, a line for each.
fn set_lines(spec: &Spec, lines: &str) -> Markup {
    let names: Vec<&str> =
        spec.inputs.iter().map(|input| input.name).chain(spec.outputs.iter().map(|output| output.name)).collect();
    html! {
        div.equation tabindex="0" role="group" aria-label="the formula" { @for line in lines.split("; ") { (equation(line, &names)) } }
    }
}

/// Who computes what, as a table.
pub(crate) fn dialect(one: &Dialects, place: &Place<'_>, catalogue: &[Member]) -> Markup {
    let title = one.ruling.and_then(|number| RULINGS.iter().find(|ruling| ruling.number == number));
    let form = |form: &DialectForm| {
        html! { @for (k, id) in form.formulas.iter().enumerate() { @if k > 0 { ", " } (link(id, place, catalogue)) } @if form.formulas.is_empty() { span.quiet { "no formula of the suite" } } }
    };
    html! {
        h3 { (one.title) }
        div.wide tabindex="0" role="group" aria-label=(one.title) { table {
            thead { tr { @for one in one.forms { th scope="col" { (one.speaker.name()) } } } }
            tbody { tr { @for one in one.forms { td { (one.what) } } } tr { @for one in one.forms { td { (form(one)) } } } }
        } }
        @if let Some(ruling) = title {
            p { a href={ (place.to("rulings.html")) "#ruling-" (ruling.number) } { "Ruling " (ruling.number) } ": " (ruling.right) " " (ruling.why) }
        }
    }
}

fn unit(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}

/// The outputs by name, each with its numbers.
fn outputs<'a>(spec: &'a Spec, row: &'a [f64]) -> Vec<(&'static str, &'a [f64])> {
    let mut start = 0;
    let mut found = vec![];
    for output in spec.outputs {
        let end = start + output.shape.components();
        found.push((output.name, &row[start..end]));
        start = end;
    }
    found
}

fn list(values: impl ExactSizeIterator<Item = f64>) -> String {
    let is_one = values.len() == 1;
    let words: Vec<String> = values.map(number).collect();
    if is_one { words.concat() } else { format!("({})", words.join(", ")) }
}

/// A number in a few digits; `NaN` and `∞` by name.
fn number(x: f64) -> String {
    if x.is_nan() {
        "NaN".into()
    } else if x.is_infinite() {
        if x > 0.0 { "∞".into() } else { "−∞".into() }
    } else {
        short(x)
    }
}

/// An error in ULP, in a few digits.
fn ulp(x: f64) -> String {
    if x.is_infinite() || x.is_nan() { number(x) } else { short((x * 100.0).round() / 100.0) }
}

fn percent(share: f64) -> String {
    if share == 0.0 { "none".into() } else { format!("{:.1} %", 100.0 * share) }
}

/// Words as a sentence.
pub(crate) fn sentence(words: &str) -> String {
    let mut chars = words.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + chars.as_str() + ".")
}

/// How a mistake looks, in words.
fn looks(look: &MistakeLook) -> String {
    let outputs: Vec<&str> = look.outputs.iter().map(|name| &**name).collect();
    if look.failing == 0 {
        return written(&format!("None of {} cases goes wrong: it takes inputs that are drawn for it.", look.cases));
    }
    let side = match (look.too_great, look.too_small) {
        (0, 0) => String::new(),
        (_, 0) => ", all too great".into(),
        (0, _) => ", all too small".into(),
        (great, small) if great > 4 * small => ", mostly too great".into(),
        (great, small) if small > 4 * great => ", mostly too small".into(),
        _ => ", too great or too small".into(),
    };
    let go = if look.failing == 1 { "goes" } else { "go" };
    let counts = written(&format!("{} of {}", look.failing, look.cases));
    format!("{counts} cases {go} wrong, in {}{side}.", outputs.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::select::catalogue;

    /// What a line says, without its spaces and its round brackets: a bar of a fraction and a place above the line may stand for these.
    fn told(line: &str) -> String {
        let mut told = String::new();
        for c in line.chars().filter(|c| !c.is_whitespace() && !matches!(c, '(' | ')' | '^')) {
            match c {
                '⁰' => told.push('0'),
                '¹' => told.push('1'),
                '²' => told.push('2'),
                '³' => told.push('3'),
                '⁴' => told.push('4'),
                '⁵' => told.push('5'),
                '⁶' => told.push('6'),
                '⁷' => told.push('7'),
                '⁸' => told.push('8'),
                '⁹' => told.push('9'),
                '⁻' => told.push('−'),
                'ⁿ' | 'ₙ' => told.push('n'),
                'ᵏ' => told.push('k'),
                'ʲ' => told.push('j'),
                'ᵀ' => told.push('T'),
                'ᵢ' => told.push('i'),
                '₀' => told.push('0'),
                '₁' => told.push('1'),
                '₂' => told.push('2'),
                '½' => told.push_str("1/2"),
                '¼' => told.push_str("1/4"),
                '_' => {}
                '∗' => told.push('*'),
                c => told.push(c),
            }
        }
        told
    }

    /// The parts of an element, each with its tags.
    fn parts(mathml: &str) -> Vec<&str> {
        let (mut parts, mut depth, mut start) = (vec![], 0, 0);
        for (at, _) in mathml.match_indices('<') {
            if depth == 0 {
                start = at;
            }
            depth += if mathml[at..].starts_with("</") { -1 } else { 1 };
            if depth == 0 {
                let end = at + mathml[at..].find('>').expect("a tag ends") + 1;
                parts.push(&mathml[start..end]);
            }
        }
        parts
    }

    /// MathML as a line again; fails where an element is empty or its fences have no partners.
    fn line_of(mathml: &str) -> String {
        let mut line = String::new();
        for part in parts(mathml) {
            let name = part[1..].split(['>', ' ']).next().unwrap_or_default();
            let inner = &part[part.find('>').expect("a tag ends") + 1..part.rfind("</").expect("an element ends")];
            match name {
                "mi" | "mn" | "mo" | "mtext" => {
                    line += &inner.replace("&lt;", "<").replace("&gt;", ">").replace("&#x2061;", "");
                }
                "mfrac" => {
                    let [over, under] = parts(inner)[..] else { panic!("a fraction of two parts: {part}") };
                    let [over, under] = [line_of(over), line_of(under)];
                    assert!(!over.is_empty() && !under.is_empty(), "a fraction has an empty part: {mathml}");
                    line += &format!("{over}/{under}");
                }
                "msqrt" => line += &format!("√{}", line_of(inner)),
                "mrow" | "msup" | "msub" | "math" => {
                    let own = line_of(inner);
                    assert!(!own.is_empty(), "an element is empty: {mathml}");
                    line += &own;
                }
                other => panic!("an element `{other}` in {mathml}"),
            }
        }
        line
    }

    #[test]
    fn each_mistake_is_shown_by_a_picture_a_plot_or_numbers() {
        let catalogue = catalogue();
        let of_some = ["interpolation/edge", "fog/exp", "lighting/blinn", "vector/normalize", "color/srgb-decode"];
        let is_shown = |member: &&Member| {
            matches!(member.spec.kind, Kind::Raster(_)) || of_some.contains(&member.spec.id.as_str())
        };
        let shaders = Shaders::built_in().expect("they are right");
        let (mut grids, mut plots, mut numbers) = (0, 0, 0);
        for member in catalogue.iter().filter(is_shown) {
            let mut shown = HashSet::new();
            for fault in listed(member) {
                let page = FormulaPage {
                    member,
                    catalogue: &catalogue,
                    shaders: &shaders,
                    place: Place::new("formula/x.html"),
                };
                let html = page.mistake(fault, None, &mut shown).0;
                let [has_grid, has_plot, has_numbers] =
                    ["sketch grid", "class=\"sketch\"", "with the mistake.</p>"].map(|what| html.contains(what));
                assert!(has_grid || has_plot || has_numbers, "{} of {}: {html}", fault.name, member.spec.id);
                grids += i32::from(has_grid);
                plots += i32::from(has_plot);
                numbers += i32::from(has_numbers);
            }
        }
        assert!(grids > 0 && plots > 0 && numbers > 0, "{grids} {plots} {numbers}");
    }

    /// Whether each fence within a row has its partner there: an opening one comes first, and a closing one last.
    fn is_fenced(mathml: &str) -> bool {
        let is_fence = |part: &&str| part.starts_with("<mo ") && part.contains("fence=\"true\"");
        parts(mathml).into_iter().filter(|part| !part.starts_with("<mo") && !part.starts_with("<mi")).all(|part| {
            let inner = &part[part.find('>').expect("a tag ends") + 1..part.rfind("</").expect("an element ends")];
            let inside = parts(inner);
            let fences: Vec<&str> = inside.iter().copied().filter(is_fence).collect();
            let sign = |part: &str| part.chars().find(|c| "()⟨⟩|".contains(*c));
            let is_pair = match fences[..] {
                [] => true,
                [open, close] => {
                    let pair = sign(open).zip(sign(close));
                    matches!(pair, Some(('(', ')') | ('⟨', '⟩') | ('|', '|')))
                        && is_fence(inside.first().expect("a row with fences"))
                        && is_fence(inside.last().expect("a row with fences"))
                        && inside.len() > 2
                }
                _ => false,
            };
            is_pair && is_fenced(inner)
        })
    }

    #[test]
    fn a_sentence_is_set_below_the_equation_that_it_begins_with() {
        for (text, expected) in [
            ("color = max(src, dst), with the factors S = constant and D = 1", Some("color = max(src, dst)")),
            ("color = src·As + dst·(1 − As) where it is written, dst elsewhere", Some("color = src·As + dst·(1 − As)")),
            (
                "FS = exp(e·ln(1 − q)), q = ½|a − b|²; as published for e of 64",
                Some("FS = exp(e·ln(1 − q)), q = ½|a − b|²"),
            ),
            ("⟨v·2ᵏ⟩ with the largest component in [2⁻²⁰, 2²⁰)", Some("⟨v·2ᵏ⟩")),
            ("I of n, l and v interpolated from the vertices", None),
            ("seen = 2 if a triangle that is drawn again passes against itself, else 1", None),
        ] {
            assert_eq!(split_equation(text).map(|(line, _)| line), expected, "{text}");
        }
        assert!(is_sentence("1 where a triangle survives: back faces culled, counter-clockwise is front"));
    }

    #[test]
    fn the_equation_of_every_formula_says_what_its_line_says() {
        let mut set = 0;
        for member in catalogue() {
            let (id, text) = (&member.spec.id, member.spec.text);
            let html = set_equation(&member.spec).0;
            let own = rule(id);
            let line = if is_sentence(text) {
                split_equation(text).map_or(own.as_deref(), |(line, _)| Some(line))
            } else {
                Some(text)
            };
            assert_eq!(html.contains("<math"), line.is_some(), "{id}");
            let (Some(from), Some(line)) = (html.find("<math"), line) else { continue };
            let mathml = &html[from..html.find("</div>").expect("it ends")];
            assert_eq!(told(&line_of(mathml).replace('\u{a0}', "")), told(&line.replace("; ", "")), "{id}: {mathml}");
            assert!(is_fenced(mathml), "{id}: {mathml}");
            set += 1;
        }
        assert!(set > 70, "{set} formulas are set as mathematics");
    }
}
