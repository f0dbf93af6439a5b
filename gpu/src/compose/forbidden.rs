//! Where a vertex shader does what only a fragment shader may.

use naga::{Block, Expression, Function, Handle, Module, SampleLevel, ShaderStage, Span, Statement};
use std::collections::HashSet;

/// The first statement or expression that a vertex shader may not reach: `discard`, a derivative, or a texture's sample
/// whose level comes from derivatives.
pub(super) fn in_vertices(module: &Module) -> Option<Span> {
    let mut seen = HashSet::new();
    let entries = module.entry_points.iter().filter(|entry| entry.stage == ShaderStage::Vertex);
    entries.into_iter().find_map(|entry| in_function(module, &entry.function, &mut seen))
}

fn in_function(module: &Module, function: &Function, seen: &mut HashSet<Handle<Function>>) -> Option<Span> {
    let of_derivatives = |expression: &Expression| match expression {
        Expression::Derivative { .. } => true,
        Expression::ImageSample { level, .. } => matches!(level, SampleLevel::Auto | SampleLevel::Bias(_)),
        _ => false,
    };
    let expression = function.expressions.iter().find(|(_, expression)| of_derivatives(expression));
    let span = expression.map(|(handle, _)| function.expressions.get_span(handle));
    span.or_else(|| in_block(module, &function.body, seen))
}

fn in_block(module: &Module, block: &Block, seen: &mut HashSet<Handle<Function>>) -> Option<Span> {
    block.span_iter().find_map(|(statement, span)| match statement {
        Statement::Kill => Some(*span),
        Statement::Call { function, .. } if seen.insert(*function) => {
            in_function(module, &module.functions[*function], seen)
        }
        Statement::Block(inner) => in_block(module, inner, seen),
        Statement::If { accept, reject, .. } => {
            in_block(module, accept, seen).or_else(|| in_block(module, reject, seen))
        }
        Statement::Switch { cases, .. } => cases.iter().find_map(|case| in_block(module, &case.body, seen)),
        Statement::Loop { body, continuing, .. } => {
            in_block(module, body, seen).or_else(|| in_block(module, continuing, seen))
        }
        _ => None,
    })
}
