//! Built-in functions of numbers.

use super::{Body, Value, pair};
use crate::rung::dialect::{Dialect, Shape};
use crate::rung::writer::READS_BITS;
use naga::MathFunction;
use naga::common::wgsl::TryToWgsl as _;

/// Built-in functions that drivers get right in f64.
const RIGHT_IN_F64: [&str; 14] = [
    "abs",
    "sign",
    "floor",
    "ceil",
    "trunc",
    "round",
    "min",
    "max",
    "clamp",
    "dot",
    "cross",
    "sqrt",
    "inverseSqrt",
    "mix",
];
/// Built-in functions of vectors that are not those of their components.
const OF_VECTORS: [&str; 8] = ["dot", "cross", "length", "distance", "normalize", "reflect", "refract", "faceForward"];

impl Body<'_, '_> {
    pub(super) fn math(
        &mut self,
        value: Value,
        fun: MathFunction,
        arguments: &[Value],
        is_plain: bool,
    ) -> Result<String, String> {
        let name = fun.try_to_wgsl().ok_or_else(|| format!("a function without a name: {fun:?}"))?;
        let dialect = self.dialect(is_plain);
        let texts: Vec<String> =
            arguments.iter().map(|argument| self.operand(*argument, is_plain)).collect::<Result<_, _>>()?;
        let native = format!("{name}({})", texts.join(", "));
        let Some(shape) = self.shape(arguments[0]) else {
            return if self.shape(value).is_some() { self.raise(value, &native) } else { Ok(native) };
        };
        if is_plain {
            return Ok(native);
        }
        if name.starts_with("pack") || name == "quantizeToF16" {
            return if dialect == Dialect::Single { Ok(native) } else { Err(READS_BITS.into()) };
        }
        let width = shape.width();
        let own = |width: u8| format!("rung_{name}_{width}");
        let widened: Vec<String> = texts
            .iter()
            .zip(arguments)
            .map(|(text, argument)| match self.shape(*argument) {
                Some(Shape::Scalar) if width > 1 => dialect.splat(width, text),
                _ => text.clone(),
            })
            .collect();
        if self.writer.prelude.has(&own(width)) {
            return Ok(format!("{}({})", own(width), widened.join(", ")));
        }
        if width > 1 && self.writer.prelude.has(&own(1)) && !OF_VECTORS.contains(&name) {
            let parts: Vec<String> = (0..width)
                .map(|k| {
                    let index = k.to_string();
                    let of: Vec<String> = widened.iter().map(|text| dialect.component(text, &index)).collect();
                    format!("{}({})", own(1), of.join(", "))
                })
                .collect();
            return Ok(match dialect {
                Dialect::Pair => pair::vector(width, &parts),
                _ => format!("{}({})", dialect.type_of(shape), parts.join(", ")),
            });
        }
        match dialect {
            Dialect::Single | Dialect::Half => Ok(native),
            Dialect::Double if RIGHT_IN_F64.contains(&name) => Ok(native),
            Dialect::Double | Dialect::Pair => Err(format!("`{name}` has no form there")),
        }
    }
}
