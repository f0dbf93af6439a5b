//! Vectors and operations of double-floats.

use crate::rung::dialect::{Dialect, Shape, plain_vector};
use crate::rung::writer::operator;
use naga::BinaryOperator;

/// A vector of these components.
pub(super) fn vector(size: u8, parts: &[String]) -> String {
    let vector = plain_vector(size);
    let half = |part: &str| parts.iter().map(|text| format!("{text}.{part}")).collect::<Vec<_>>().join(", ");
    format!("DF{size}({vector}({}), {vector}({}))", half("hi"), half("lo"))
}

/// What the prelude has for an operator between two values, each with its shape.
pub(super) fn operation(op: BinaryOperator, left: (Shape, &str), right: (Shape, &str)) -> Result<String, String> {
    use BinaryOperator as B;
    let name = match op {
        B::Add => "add",
        B::Subtract => "sub",
        B::Multiply => "mul",
        B::Divide => "div",
        B::Equal => "eq",
        B::NotEqual => "ne",
        B::Less => "lt",
        B::LessEqual => "le",
        B::Greater => "gt",
        B::GreaterEqual => "ge",
        other => return Err(format!("`{}` has no double-float form", operator(other))),
    };
    let ((a, x), (b, y)) = (left, right);
    match (a, b) {
        (Shape::Matrix(columns, rows), Shape::Vector(_)) if op == B::Multiply => Ok(columns_by(x, columns, rows, y)),
        (Shape::Matrix(columns, rows), Shape::Matrix(others, _)) if op == B::Multiply => {
            let products: Vec<String> =
                (0..others).map(|k| columns_by(x, columns, rows, &format!("{y}[{k}]"))).collect();
            Ok(format!("array<DF{rows}, {others}>({})", products.join(", ")))
        }
        (Shape::Matrix(..), _) | (_, Shape::Matrix(..)) => {
            Err("an operation on matrices has no double-float form".into())
        }
        _ => {
            let width = a.width().max(b.width());
            let widened = |shape: Shape, text: &str| {
                if shape.width() < width { Dialect::Pair.splat(width, text) } else { text.to_owned() }
            };
            Ok(format!("rung_{name}_{width}({}, {})", widened(a, x), widened(b, y)))
        }
    }
}

/// A matrix of double-floats times a vector, column by column.
fn columns_by(matrix: &str, columns: u8, rows: u8, vector: &str) -> String {
    let product = |k: u8| {
        let one = Dialect::Pair.component(vector, &k.to_string());
        format!("rung_mul_{rows}({matrix}[{k}], {})", Dialect::Pair.splat(rows, &one))
    };
    (1..columns).fold(product(0), |sum, k| format!("rung_add_{rows}({sum}, {})", product(k)))
}
