//! Blend states by their names, and what WebGPU has no state for.

use super::field::{At, SceneError, one_of};
use lightmeter_scene::blend::{Equation, Factor, Separate, State};
use lightmeter_scene::frame::Blend;
use lightmeter_scene::model;

/// The state of an object's blending.
pub(super) fn blend(at: &At<'_>, blend: &model::Blend) -> Result<Blend, SceneError> {
    let color = state(&at.field("color"), &blend.color)?;
    let alpha = match &blend.alpha {
        Some(alpha) => state(&at.field("alpha"), alpha)?,
        None => color,
    };
    let replicated = [color.src, color.dst].into_iter().find(|factor| factor.reads_constant_alpha());
    if let Some(factor) = replicated.filter(|_| !color.equation.ignores_factors()) {
        let holds = format_args!("is `{}`, and WebGPU has no factor {} for colours", blend.color, factor.name());
        return Err(at.field("color").refuse(holds, "constant-color with a grey constant"));
    }
    Ok(Blend { state: Separate { color, alpha }, constant: at.field("constant").numbers(blend.constant)? })
}

/// A named mode of 002, or equation and factors.
fn state(at: &At<'_>, name: &str) -> Result<State, SceneError> {
    let add = |src, dst| State { equation: Equation::Add, src, dst };
    match name {
        "solid" => return Ok(add(Factor::One, Factor::Zero)),
        "alpha" => return Ok(add(Factor::SrcAlpha, Factor::OneMinusSrcAlpha)),
        "mul" => return Ok(add(Factor::DstColor, Factor::Zero)),
        "add" => return Ok(add(Factor::SrcAlpha, Factor::One)),
        _ => {}
    }
    let parts: Vec<&str> = name.split('/').collect();
    let equation = Equation::ALL.into_iter().find(|equation| equation.name() == parts[0]);
    let Some(equation) = equation else {
        let modes = "solid, alpha, mul, add, min, max, or equation/source/destination as add/src-alpha/one";
        return Err(at.refuse(format_args!("is `{name}`"), modes));
    };
    let refuse = |allowed: &str| Err(at.refuse(format_args!("is `{name}`"), allowed));
    if equation.ignores_factors() {
        let state = State { equation, src: Factor::One, dst: Factor::One };
        return if parts.len() == 1 { Ok(state) } else { refuse("min or max alone: they have no factors") };
    }
    let factor = |name: &str| Factor::ALL.into_iter().find(|factor| factor.name() == name);
    match parts[1..] {
        [src, dst] => match (factor(src), factor(dst)) {
            (Some(src), Some(dst)) => Ok(State { equation, src, dst }),
            _ => refuse(&format!("two factors, each {}", one_of(&Factor::ALL.map(Factor::name)))),
        },
        _ => refuse("equation/source/destination, as add/src-alpha/one"),
    }
}
