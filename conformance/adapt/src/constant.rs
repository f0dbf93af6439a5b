//! The numbers of a constant expression in WGSL.

use naga::{Expression, Handle, Literal, Module};

/// The types that an input may have.
const TYPES: [&str; 4] = ["f32", "vec2f", "vec3f", "vec4f"];

/// The numbers of a constant expression in WGSL, such as `normalize(vec3f(1.0, 2.0, 0.5))` or `1.0 / 3.0`; `None` where it is none of
/// one to four floats.
#[must_use]
pub fn numbers(expression: &str) -> Option<Vec<f32>> {
    if expression.contains([';', '\n', '@']) {
        return None;
    }
    TYPES.iter().find_map(|of| {
        let module = naga::front::wgsl::parse_str(&format!("const value: {of} = {expression};")).ok()?;
        let (_, constant) = module.constants.iter().find(|(_, constant)| constant.name.as_deref() == Some("value"))?;
        let mut found = vec![];
        flatten(&module, constant.init, &mut found)?;
        Some(found)
    })
}

fn flatten(module: &Module, expression: Handle<Expression>, found: &mut Vec<f32>) -> Option<()> {
    match &module.global_expressions[expression] {
        Expression::Literal(Literal::F32(x)) => found.push(*x),
        Expression::Compose { components, .. } => {
            for &component in components {
                flatten(module, component, found)?;
            }
        }
        Expression::Splat { size, value } => {
            for _ in 0..*size as usize {
                flatten(module, *value, found)?;
            }
        }
        Expression::ZeroValue(of) => {
            let count = match &module.types[*of].inner {
                naga::TypeInner::Scalar(_) => 1,
                naga::TypeInner::Vector { size, .. } => *size as usize,
                _ => return None,
            };
            found.extend(std::iter::repeat_n(0.0, count));
        }
        _ => return None,
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::numbers;

    #[test]
    fn an_expression_is_its_numbers() {
        assert_eq!(numbers("1.0 / 4.0"), Some(vec![0.25]));
        assert_eq!(numbers("32"), Some(vec![32.0]));
        assert_eq!(numbers("vec3(2.0)"), Some(vec![2.0; 3]));
        assert_eq!(numbers("vec3f()"), Some(vec![0.0; 3]));
        let unit = numbers("normalize(vec3(3.0, 0.0, 4.0))").expect("it is constant");
        assert!(unit.iter().zip([0.6, 0.0, 0.8]).all(|(a, b)| (a - b).abs() < 1e-6), "{unit:?}");
        assert_eq!(numbers("vec4(vec2(1, 2), 3, 4)"), Some(vec![1.0, 2.0, 3.0, 4.0]));
    }

    #[test]
    fn what_is_no_number_is_none() {
        for wrong in ["", "md", "sqrt(", "mat2x2f()", "1.0; const b: f32 = 1.0", "vec3(1u)", "true"] {
            assert_eq!(numbers(wrong), None, "{wrong}");
        }
    }
}
