//! Blend and depth states as people write them: calls of OpenGL and WebGL, and the descriptors of WebGPU and Vulkan as JSON.

use lightmeter_scene::blend::{Equation, Factor, Separate, State};
use lightmeter_scene::depth::Compare;
use serde_json::Value;

/// What a state is used for, and the states that it is commonly confused with.
#[derive(Clone, Copy, Debug)]
pub struct Common {
    /// The id of its formula.
    pub id: &'static str,
    /// What it does.
    pub what: &'static str,
    /// Another state's id, and how the two are told apart.
    pub confused_with: &'static [(&'static str, &'static str)],
}

const STRAIGHT: &str = "blend/add/src-alpha/one-minus-src-alpha";
const PREMULTIPLIED: &str = "blend/add/one/one-minus-src-alpha";
const ADDED: &str = "blend/add/one/one";
const ADDED_BY_ALPHA: &str = "blend/add/src-alpha/one";
const MULTIPLIED: &str = "blend/add/dst-color/zero";
const SCREENED: &str = "blend/add/one/one-minus-src-color";

/// The states that have a use of their own.
pub const COMMON: [Common; 6] = [
    Common {
        id: STRAIGHT,
        what: "the source over the destination, of colours that are not premultiplied by alpha",
        confused_with: &[
            (PREMULTIPLIED, "which is for premultiplied colours: mixed up, edges get dark or bright fringes"),
            (ADDED_BY_ALPHA, "which adds and never darkens the destination"),
        ],
    },
    Common {
        id: PREMULTIPLIED,
        what: "the source over the destination, of colours that are premultiplied by alpha",
        confused_with: &[(STRAIGHT, "which multiplies by alpha once more: translucent colours get too dark")],
    },
    Common {
        id: ADDED,
        what: "light that is added, whatever its alpha",
        confused_with: &[(ADDED_BY_ALPHA, "which weighs the source by its alpha")],
    },
    Common {
        id: ADDED_BY_ALPHA,
        what: "light that is added by the part that alpha says",
        confused_with: &[
            (ADDED, "which does not read alpha"),
            (STRAIGHT, "which takes from the destination what it adds"),
        ],
    },
    Common {
        id: MULTIPLIED,
        what: "the destination filtered by the source",
        confused_with: &[
            ("blend/add/zero/src-color", "which is the same product from the other side"),
            ("blend/add/dst-color/src-color", "which is twice the product"),
        ],
    },
    Common {
        id: SCREENED,
        what: "the screen of both: never darker than either",
        confused_with: &[
            ("blend/add/one-minus-dst-color/one", "which is the same sum from the other side"),
            (ADDED, "which leaves the range of a target sooner"),
        ],
    },
];

/// The id of the formula that a state computes, as somebody writes the state; `None` of what is no state at all.
///
/// # Errors
/// Where a word of it is unknown, or something is missing: says what would be right.
pub fn written_state(text: &str) -> Option<Result<String, String>> {
    let text = text.trim();
    if text.starts_with('{') {
        return Some(of_json(text));
    }
    let calls: Vec<Call<'_>> =
        text.split(';').map(str::trim).filter(|call| !call.is_empty()).map_while(Call::read).collect();
    (!calls.is_empty()).then(|| of_calls(&calls))
}

/// `glBlendFunc(GL_ONE, GL_ZERO)`.
struct Call<'a> {
    name: String,
    words: Vec<&'a str>,
}

impl<'a> Call<'a> {
    fn read(text: &'a str) -> Option<Self> {
        let (name, rest) = text.split_once('(')?;
        let words = rest.strip_suffix(')')?.split(',').map(str::trim).collect();
        let name = name.trim().trim_start_matches("gl.").trim_start_matches("gl").to_lowercase();
        ["blend", "depth", "enable", "disable"]
            .iter()
            .any(|start| name.starts_with(start))
            .then_some(Self { name, words })
    }
}

fn of_calls(calls: &[Call<'_>]) -> Result<String, String> {
    let mut factors = [[Factor::One, Factor::Zero]; 2];
    let mut equations = [Equation::Add; 2];
    let (mut compare, mut writes, mut blends) = (None, true, true);
    for Call { name, words } in calls {
        match (name.as_str(), words.as_slice()) {
            ("blendfunc", [src, dst]) => factors = [[factor(src)?, factor(dst)?]; 2],
            ("blendfuncseparate", [src, dst, src_alpha, dst_alpha]) => {
                factors = [[factor(src)?, factor(dst)?], [factor(src_alpha)?, factor(dst_alpha)?]];
            }
            ("blendequation", [both]) => equations = [equation(both)?; 2],
            ("blendequationseparate", [color, alpha]) => equations = [equation(color)?, equation(alpha)?],
            ("blendcolor", _) => {}
            ("enable" | "disable", [one]) if plain(one) == "blend" => blends = name == "enable",
            ("enable", [one]) if plain(one) == "depth-test" => {}
            ("depthfunc", [one]) => compare = Some(compared(one)?),
            ("depthmask", [one]) => writes = plain(one) != "false" && *one != "0",
            _ => {
                return Err(format!(
                    "`{name}` with {} words is no call that sets a state; expected glBlendFunc(SRC, DST), \
                     glBlendFuncSeparate(SRC, DST, SRC_ALPHA, DST_ALPHA), glBlendEquation(MODE), glBlendEquationSeparate(MODE, MODE), \
                     glEnable(GL_BLEND), glDisable(GL_BLEND), glDepthFunc(FUNC) or glDepthMask(FLAG)",
                    words.len()
                ));
            }
        }
    }
    if let Some(compare) = compare {
        return Ok(depth_id(compare, writes));
    }
    if !blends {
        return Ok(blend_id(OVERWRITE, OVERWRITE));
    }
    let state = |k: usize| State { equation: equations[k], src: factors[k][0], dst: factors[k][1] };
    Ok(blend_id(state(0), state(1)))
}

fn of_json(text: &str) -> Result<String, String> {
    let value: Value = serde_json::from_str(text).map_err(|error| format!("it is no JSON: {error}"))?;
    if value.get("depthCompare").is_some() || value.get("depthCompareOp").is_some() {
        return of_depth(&value);
    }
    if value.get("srcColorBlendFactor").is_some() || value.get("blendEnable").is_some() {
        return of_vulkan(&value);
    }
    // WebGPU's state of a target has one object for its colour and one for its alpha, and stands beneath `blend`.
    let target = value.get("blend").is_some() || value.get("writeMask").is_some();
    let blend = if target { value.get("blend") } else { Some(&value) };
    if target {
        whole_mask(value.get("writeMask"))?;
        if blend.is_none_or(Value::is_null) {
            return Ok(blend_id(OVERWRITE, OVERWRITE));
        }
    }
    let component = |name: &str| blend.and_then(|blend| blend.get(name));
    match (component("color"), component("alpha")) {
        (Some(color), Some(alpha)) => Ok(blend_id(of_webgpu(color)?, of_webgpu(alpha)?)),
        (Some(_), None) => Err("`alpha` is missing; WebGPU wants {\"color\": {…}, \"alpha\": {…}}".into()),
        (None, Some(_)) => Err("`color` is missing; WebGPU wants {\"color\": {…}, \"alpha\": {…}}".into()),
        (None, None) => Err(
            "it is no state; expected WebGPU's {\"color\": {…}, \"alpha\": {…}} or {\"depthCompare\": …}, or Vulkan's \
                             {\"srcColorBlendFactor\": …} or {\"depthCompareOp\": …}"
                .into(),
        ),
    }
}

/// The state of a target that does not blend.
const OVERWRITE: State = State { equation: Equation::Add, src: Factor::One, dst: Factor::Zero };

fn of_depth(value: &Value) -> Result<String, String> {
    let flag = |names: [&str; 2]| names.iter().find_map(|name| value.get(name));
    let off = |flag: &Value| flag == &Value::Bool(false) || flag == "VK_FALSE" || flag == &Value::from(0);
    if value.get("depthTestEnable").is_some_and(off) {
        return Err("`depthTestEnable` is off, and so nothing is tested or written; turn it on, or leave it out".into());
    }
    let word = flag(["depthCompare", "depthCompareOp"]).and_then(Value::as_str);
    let word = word.ok_or("what is compared is no word, as \"less\"")?;
    let writes = !flag(["depthWriteEnabled", "depthWriteEnable"]).is_some_and(off);
    Ok(depth_id(compared(word)?, writes))
}

fn of_webgpu(component: &Value) -> Result<State, String> {
    let fields = component
        .as_object()
        .ok_or_else(|| format!("`{component}` is no object of `srcFactor`, `dstFactor` and `operation`"))?;
    let word = |name: &str, otherwise: &str| match fields.get(name) {
        None => Ok(otherwise.to_owned()),
        Some(value) => {
            value.as_str().map(str::to_owned).ok_or_else(|| format!("`{name}` is {value}, which is no word"))
        }
    };
    const NAMES: [&str; 3] = ["srcFactor", "dstFactor", "operation"];
    if let Some(other) = fields.keys().find(|name| !NAMES.contains(&name.as_str())) {
        return Err(unknown("field", other, other, &NAMES));
    }
    Ok(State {
        equation: equation(&word("operation", "add")?)?,
        src: factor(&word("srcFactor", "one")?)?,
        dst: factor(&word("dstFactor", "zero")?)?,
    })
}

fn of_vulkan(value: &Value) -> Result<String, String> {
    whole_mask(value.get("colorWriteMask"))?;
    if value.get("blendEnable").is_some_and(|on| on == &Value::Bool(false) || on == "VK_FALSE" || on == &Value::from(0))
    {
        return Ok(blend_id(OVERWRITE, OVERWRITE));
    }
    let state = |part: &str| -> Result<State, String> {
        let of = |name: String| value.get(&name).and_then(Value::as_str).ok_or(format!("`{name}` is missing"));
        Ok(State {
            equation: equation(of(format!("{}BlendOp", part.to_lowercase())).unwrap_or("VK_BLEND_OP_ADD"))?,
            src: factor(of(format!("src{part}BlendFactor"))?)?,
            dst: factor(of(format!("dst{part}BlendFactor"))?)?,
        })
    };
    Ok(blend_id(state("Color")?, state("Alpha")?))
}

/// A mask of channels that writes all four: no formula says what becomes of channels that are not written.
fn whole_mask(mask: Option<&Value>) -> Result<(), String> {
    let Some(mask) = mask else { return Ok(()) };
    let whole = match mask {
        Value::String(bits) => "RGBA".chars().all(|channel| {
            bits.split('|').any(|bit| {
                let bit = bit.trim().trim_start_matches("GPUColorWrite.").trim_start_matches("VK_COLOR_COMPONENT_");
                bit == "ALL" || bit.strip_suffix("_BIT").unwrap_or(bit).chars().eq([channel])
            })
        }),
        number => number.as_u64() == Some(0xf),
    };
    if whole {
        return Ok(());
    }
    Err(format!(
        "the mask {mask} does not write all channels; a channel that is not written keeps its value. Leave the mask out to see what the others do"
    ))
}

/// A word without what says of which interface it is: `GL_SRC_ALPHA`, `gl.SRC_ALPHA` and `VK_BLEND_FACTOR_SRC_ALPHA` are `src-alpha`.
fn plain(word: &str) -> String {
    let mut word = word.trim().to_uppercase().replace('-', "_");
    for start in ["GL_", "GL.", "VK_BLEND_FACTOR_", "VK_BLEND_OP_", "VK_COMPARE_OP_", "FUNC_"] {
        word = word.strip_prefix(start).map_or(word.clone(), str::to_owned);
    }
    word.to_lowercase().replace('_', "-")
}

fn factor(word: &str) -> Result<Factor, String> {
    let name = match plain(word).as_str() {
        "0" => "zero".into(),
        "1" => "one".into(),
        "src" => "src-color".into(),
        "one-minus-src" => "one-minus-src-color".into(),
        "dst" => "dst-color".into(),
        "one-minus-dst" => "one-minus-dst-color".into(),
        "constant" => "constant-color".into(),
        "one-minus-constant" => "one-minus-constant-color".into(),
        "src-alpha-saturated" => "src-alpha-saturate".into(),
        other => other.to_owned(),
    };
    let names = Factor::ALL.map(Factor::name);
    Factor::ALL.into_iter().find(|factor| factor.name() == name).ok_or_else(|| unknown("factor", word, &name, &names))
}

fn equation(word: &str) -> Result<Equation, String> {
    let name = plain(word);
    let names = Equation::ALL.map(Equation::name);
    Equation::ALL.into_iter().find(|one| one.name() == name).ok_or_else(|| unknown("equation", word, &name, &names))
}

fn compared(word: &str) -> Result<Compare, String> {
    let name = match plain(word).as_str() {
        "lequal" | "less-or-equal" => "less-equal".to_owned(),
        "gequal" | "greater-or-equal" => "greater-equal".to_owned(),
        "notequal" => "not-equal".to_owned(),
        other => other.to_owned(),
    };
    let names = Compare::ALL.map(Compare::name);
    Compare::ALL.into_iter().find(|one| one.name() == name).ok_or_else(|| unknown("depth test", word, &name, &names))
}

fn unknown(what: &str, word: &str, name: &str, names: &[&str]) -> String {
    let meant = crate::nearest::did_you_mean(name, names.iter().copied());
    format!("no {what} `{word}`{meant} There are {}", names.join(", "))
}

fn blend_id(color: State, alpha: State) -> String {
    let (color, alpha) = (color.canonical(), alpha.canonical());
    if color == alpha {
        return match color.equation {
            Equation::Min | Equation::Max => format!("blend/{}", color.equation.name()),
            equation => format!("blend/{}/{}/{}", equation.name(), color.src.name(), color.dst.name()),
        };
    }
    format!("blend/separate/{}", Separate { color, alpha })
}

fn depth_id(compare: Compare, writes: bool) -> String {
    format!("depth/test/{}/{}", compare.name(), if writes { "write" } else { "keep" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::blend::separate_of;

    fn id(text: &str) -> String {
        written_state(text).expect("it is a state").unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[test]
    fn a_state_is_the_same_in_every_interface() {
        for text in [
            "glBlendFunc(GL_SRC_ALPHA, GL_ONE)",
            "gl.blendFunc(gl.SRC_ALPHA, gl.ONE);",
            "glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE, GL_SRC_ALPHA, GL_ONE); glBlendEquation(GL_FUNC_ADD);",
            r#"{"color": {"srcFactor": "src-alpha", "dstFactor": "one"}, "alpha": {"srcFactor": "src-alpha", "dstFactor": "one", "operation": "add"}}"#,
            r#"{"srcColorBlendFactor": "VK_BLEND_FACTOR_SRC_ALPHA", "dstColorBlendFactor": "VK_BLEND_FACTOR_ONE", "colorBlendOp": "VK_BLEND_OP_ADD",
                "srcAlphaBlendFactor": "VK_BLEND_FACTOR_SRC_ALPHA", "dstAlphaBlendFactor": "VK_BLEND_FACTOR_ONE"}"#,
        ] {
            assert_eq!(id(text), "blend/add/src-alpha/one");
        }
        assert_eq!(id("glBlendEquation(GL_MAX)"), "blend/max");
        for text in [
            "glDepthFunc(GL_LEQUAL); glDepthMask(GL_FALSE)",
            r#"{"depthCompareOp": "VK_COMPARE_OP_LESS_OR_EQUAL", "depthWriteEnable": false}"#,
        ] {
            assert_eq!(id(text), "depth/test/less-equal/keep");
        }
        let separate = id("glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ZERO)");
        assert_eq!(separate, "blend/separate/add.src-alpha.one-minus-src-alpha/add.one.zero");
        assert!(separate_of(&separate).is_some());
    }

    #[test]
    fn every_factor_and_equation_is_known_in_both_spellings() {
        for factor in Factor::ALL {
            let gl = factor.name().to_uppercase().replace('-', "_");
            for word in [format!("GL_{gl}"), format!("VK_BLEND_FACTOR_{gl}"), factor.name().to_owned()] {
                assert_eq!(super::factor(&word), Ok(factor), "{word}");
            }
        }
        for equation in Equation::ALL {
            let gl = equation.name().to_uppercase().replace('-', "_");
            for word in [format!("GL_FUNC_{gl}"), format!("VK_BLEND_OP_{gl}"), equation.name().to_owned()] {
                assert_eq!(super::equation(&word), Ok(equation), "{word}");
            }
        }
    }

    #[test]
    fn what_is_no_state_says_what_would_be() {
        assert!(written_state("fog/exp").is_none());
        let error = |text: &str| written_state(text).expect("it is meant as one").expect_err("it is refused");
        assert!(error("glBlendFunc(GL_SRC_ALPA, GL_ONE)").contains("did you mean `src-alpha`"));
        assert!(error("glBlendFunc(GL_ONE)").contains("expected glBlendFunc(SRC, DST)"));
        assert!(error("{\"a\": 1}").contains("expected WebGPU's"));
        assert!(error(r#"{"color": {"srcFactor": "one"}}"#).contains("`alpha` is missing"));
        assert!(error(r#"{"color": {"srcFactr": "one"}, "alpha": {}}"#).contains("did you mean `srcFactor`"));
        assert!(error(r#"{"color": {"srcFactor": 1}, "alpha": {}}"#).contains("which is no word"));
        assert!(error(r#"{"writeMask": 7}"#).contains("does not write all channels"));
        assert!(
            error(r#"{"blendEnable": true, "colorWriteMask": "VK_COLOR_COMPONENT_R_BIT"}"#)
                .contains("does not write all")
        );
        assert!(error(r#"{"blendEnable": true}"#).contains("`srcColorBlendFactor` is missing"));
        assert!(
            error(r#"{"depthCompareOp": "VK_COMPARE_OP_LESS", "depthTestEnable": false}"#).contains("depthTestEnable")
        );
    }

    #[test]
    fn a_target_that_does_not_blend_is_overwritten() {
        for text in [
            "glDisable(GL_BLEND); glBlendFunc(GL_SRC_ALPHA, GL_ONE)",
            r#"{"blendEnable": "VK_FALSE", "srcColorBlendFactor": "VK_BLEND_FACTOR_SRC_ALPHA", "dstColorBlendFactor": "VK_BLEND_FACTOR_ONE",
                "srcAlphaBlendFactor": "VK_BLEND_FACTOR_ONE", "dstAlphaBlendFactor": "VK_BLEND_FACTOR_ONE", "colorWriteMask": 15}"#,
            r#"{"format": "rgba8unorm", "writeMask": 15}"#,
            r#"{"color": {}, "alpha": {}}"#,
        ] {
            assert_eq!(id(text), "blend/add/one/zero", "{text}");
        }
        assert_eq!(id("gl.enable(gl.BLEND); gl.blendFunc(gl.ONE, gl.ONE)"), "blend/add/one/one");
        let masked = r#"{"blend": {"color": {"dstFactor": "one"}, "alpha": {"dstFactor": "one"}}, "writeMask": "GPUColorWrite.ALL"}"#;
        assert_eq!(id(masked), "blend/add/one/one");
    }

    #[test]
    fn the_common_states_are_states() {
        let states: Vec<String> = State::all().map(|state| blend_id(state, state)).collect();
        for common in COMMON {
            for id in common.confused_with.iter().map(|(id, _)| *id).chain([common.id]) {
                assert!(states.iter().any(|state| state == id), "{id}");
            }
        }
    }
}
