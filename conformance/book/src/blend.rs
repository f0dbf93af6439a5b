//! The pages of blending: one for each equation and each factor. The modes have the page of a formula.

use crate::contents::Place;
use crate::diagram;
use crate::formula::{FormulaPage, dialect, sentence};
use crate::picture::FormulaPicture;
use lightmeter_catalogue::cases::blend::COMMON;
use lightmeter_catalogue::dialects::DIALECTS;
use lightmeter_catalogue::select::Member;
use lightmeter_gpu::Shaders;
use lightmeter_report::html::equation;
use lightmeter_scene::blend::{Equation, Factor, State};
use maud::{Markup, html};

/// The state by which an equation is shown.
pub(crate) const fn shown_by(equation: Equation) -> State {
    match equation {
        Equation::Min | Equation::Max => State { equation, src: Factor::One, dst: Factor::One },
        _ => State { equation, src: Factor::SrcAlpha, dst: Factor::OneMinusSrcAlpha },
    }
}

fn member_of(catalogue: &[Member], state: State) -> Option<&Member> {
    let id = format!("blend/{state}");
    catalogue.iter().find(|member| member.spec.id == id)
}

/// The page of an equation.
pub(crate) fn of_equation(one: Equation, catalogue: &[Member], shaders: &Shaders, place: Place<'_>) -> Markup {
    let state = shown_by(one);
    let Some(member) = member_of(catalogue, state) else { return html! {} };
    let page = FormulaPage { member, catalogue, shaders, place };
    let picture = FormulaPicture::of(member);
    html! {
        h1 { "The blend equation " code { (one.name()) } }
        (page.statement())
        (diagram::blend(one))
        p {
            @if one.ignores_factors() { "The factors are ignored: all 225 pairs of factors are the same state. A driver that multiplies by them first is wrong, and the suite has cases of its own for that." }
            @else { "S and D are factors, each one of " a href=(place.to("formula/index.html#factors")) { "fifteen" } ". All 225 pairs are judged. The figures below are those of " code { (member.spec.id) } "." }
        }
        (names(&format!("GL_FUNC_{}", one.name()), one.name(), &format!("VK_BLEND_OP_{}", one.name()), one.ignores_factors()))
        @if let Some(picture) = &picture { figure.picture { (picture.img(member)) figcaption { (picture.caption(member)) } } }
        (page.course())
        (page.code())
        (page.accuracy())
        (page.hard())
        (page.mistakes(picture.as_ref()))
        (commons(|state| state.equation == one, &place))
        pre tabindex="0" { code { "lightmeter run 'blend/" (one.name()) "/*'" } }
    }
}

/// The page of a factor.
pub(crate) fn of_factor(factor: Factor, catalogue: &[Member], shaders: &Shaders, place: Place<'_>) -> Markup {
    let of = |src, dst| member_of(catalogue, State { equation: Equation::Add, src, dst });
    let (Some(as_source), Some(as_destination)) = (of(factor, Factor::Zero), of(Factor::Zero, factor)) else {
        return html! {};
    };
    let page = FormulaPage { member: as_source, catalogue, shaders, place };
    let [color, alpha] = factor.formulas();
    let names_known = ["Cs", "As", "Cd", "Ad", "Cc", "Ac"];
    let pictures = [
        (as_source, "as S, the source's factor, with D = 0"),
        (as_destination, "as D, the destination's factor, with S = 0"),
    ];
    html! {
        h1 { "The blend factor " code { (factor.name()) } }
        div.equation tabindex="0" role="group" aria-label="the factor" { (equation(&format!("factor = {color} in the colour, {alpha} in alpha"), &names_known)) }
        p {
            "Cs and As are the colour and the alpha of the source, Cd and Ad those of the destination, Cc and Ac those of the blend constant."
            @if factor.reads_constant_alpha() { " WebGPU has no factor that is the constant's alpha in the colour: there the suite reaches the state by a constant whose colour is its alpha." }
        }
        (diagram::blend(Equation::Add))
        (names(&format!("GL_{}", factor.name()), factor.name(), &format!("VK_BLEND_FACTOR_{}", factor.name()), false))
        div.pictures {
            @for (member, what) in pictures {
                @if let Some(picture) = FormulaPicture::of(member) { figure.picture { (picture.img(member)) figcaption { (what) ": " (picture.caption(member)) } } }
            }
        }
        (page.course())
        @for one in DIALECTS.iter().filter(|one| one.title.to_lowercase().replace('_', "-") == factor.name()) { h2 #dialects { "Who computes what" } (dialect(one, &place, catalogue)) }
        (page.code())
        (page.accuracy())
        (page.mistakes(FormulaPicture::of(as_source).as_ref()))
        (commons(|state| state.src == factor || state.dst == factor, &place))
        pre tabindex="0" { code { "lightmeter run 'blend/*/" (factor.name()) "/*' 'blend/*/*/" (factor.name()) "'" } }
    }
}

/// What it is called elsewhere.
fn names(opengl: &str, own: &str, vulkan: &str, is_plain: bool) -> Markup {
    let upper = |name: &str| name.to_uppercase().replace('-', "_");
    let opengl = if is_plain { opengl.replace("FUNC_", "") } else { opengl.to_owned() };
    // WebGPU calls the colour of the source `src`, and has the constant's colour alone.
    let webgpu = match own {
        "constant-color" => "constant".to_owned(),
        "one-minus-constant-color" => "one-minus-constant".to_owned(),
        "constant-alpha" | "one-minus-constant-alpha" => "none".to_owned(),
        "src-alpha-saturate" => "src-alpha-saturated".to_owned(),
        other => other.strip_suffix("-color").unwrap_or(other).to_owned(),
    };
    html! {
        div.wide tabindex="0" role="group" aria-label="names" { table {
            thead { tr { th scope="col" { "OpenGL" } th scope="col" { "WebGPU" } th scope="col" { "Vulkan" } } }
            tbody { tr { td { code { (upper(&opengl)) } } td { code { (webgpu) } } td { code { (upper(vulkan)) } } } }
        } }
    }
}

/// The states that have a use of their own, among some.
fn commons(is_its: impl Fn(State) -> bool, place: &Place<'_>) -> Markup {
    let state = |id: &str| State::all().find(|state| format!("blend/{state}") == id);
    let found: Vec<_> = COMMON.iter().filter(|common| state(common.id).is_some_and(&is_its)).collect();
    html! {
        @if !found.is_empty() {
            h2 #uses { "What it is used for" }
            ul { @for common in found { li {
                code { (common.id) } ": " (sentence(common.what))
                @for (other, told) in common.confused_with { " It is commonly confused with " code { (other) } ", " (told) "." }
            } } }
            p.hint { "All states are made of " a href=(place.to("formula/index.html#factors")) { "the same factors and equations" } "." }
        }
    }
}
