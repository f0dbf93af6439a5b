//! What gives no value: loops without a way out, and shaders that never write what they give.

use lightmeter_shaders::read::Role;
use lightmeter_shaders::read::ShaderSource;
use naga::{Block, Expression, Function, GlobalVariable, Handle, Module, Span, Statement};

/// Refuses loops without a way out, and a shader that never writes what it gives: with the line of the loop where there is a text.
pub(crate) fn ends(
    module: &Module,
    entry: Handle<Function>,
    source: &ShaderSource,
) -> Result<(), (Option<usize>, String)> {
    let (text, before) = &source.read;
    let line = |span: Span| {
        let place = (!text.is_empty() && span != Span::UNDEFINED).then(|| span.location(text).line_number as usize)?;
        Some(place.saturating_sub(*before).max(1))
    };
    for (_, function) in module.functions.iter() {
        if let Some(span) = endless(&function.body) {
            let message = "a loop has no way out: no condition, no break and no return; give it an end".into();
            return Err((line(span), message));
        }
    }
    let is_output = |variable: &GlobalVariable| {
        source.roles.iter().any(|(name, role)| *role == Role::Output && Some(name) == variable.name.as_ref())
    };
    let gives: Vec<Handle<GlobalVariable>> =
        module.global_variables.iter().filter(|(_, one)| is_output(one)).map(|(handle, _)| handle).collect();
    // A function that is named gives its value and no output.
    let is_whole = module.functions[entry].name.as_deref() == Some("entry");
    if is_whole && !gives.is_empty() && !gives.iter().any(|handle| is_written(module, *handle)) {
        let given: Vec<&str> =
            gives.iter().filter_map(|handle| module.global_variables[*handle].name.as_deref()).collect();
        return Err((None, format!("it never writes {}: it gives nothing that could be judged", given.join(", "))));
    }
    Ok(())
}

/// Whether some function stores into a variable, or hands it on to one that may.
fn is_written(module: &Module, variable: Handle<GlobalVariable>) -> bool {
    module.functions.iter().any(|(_, function)| {
        let leads = |pointer: Handle<Expression>| {
            let mut at = pointer;
            loop {
                at = match function.expressions[at] {
                    Expression::GlobalVariable(own) => return own == variable,
                    Expression::AccessIndex { base, .. } | Expression::Access { base, .. } => base,
                    _ => return false,
                };
            }
        };
        writes(&function.body, &leads)
    })
}

fn writes(block: &Block, leads: &dyn Fn(Handle<Expression>) -> bool) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Store { pointer, .. } => leads(*pointer),
        Statement::Call { arguments, .. } => arguments.iter().any(|argument| leads(*argument)),
        Statement::Block(block) => writes(block, leads),
        Statement::If { accept, reject, .. } => writes(accept, leads) || writes(reject, leads),
        Statement::Switch { cases, .. } => cases.iter().any(|case| writes(&case.body, leads)),
        Statement::Loop { body, continuing, .. } => writes(body, leads) || writes(continuing, leads),
        _ => false,
    })
}

/// The first loop that has no way out: no condition at its end, and neither break, return nor discard within.
fn endless(block: &Block) -> Option<Span> {
    block.span_iter().find_map(|(statement, span)| match statement {
        Statement::Loop { body, continuing, break_if } => {
            if break_if.is_none() && !leaves(body, true) && !leaves(continuing, true) {
                return Some(*span);
            }
            endless(body).or_else(|| endless(continuing))
        }
        Statement::Block(block) => endless(block),
        Statement::If { accept, reject, .. } => endless(accept).or_else(|| endless(reject)),
        Statement::Switch { cases, .. } => cases.iter().find_map(|case| endless(&case.body)),
        _ => None,
    })
}

/// Whether a block may leave the loop around it; `breaks` says whether a break there is that loop's.
fn leaves(block: &Block, breaks: bool) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Return { .. } | Statement::Kill => true,
        Statement::Break => breaks,
        Statement::Block(block) => leaves(block, breaks),
        Statement::If { accept, reject, .. } => leaves(accept, breaks) || leaves(reject, breaks),
        Statement::Switch { cases, .. } => cases.iter().any(|case| leaves(&case.body, false)),
        Statement::Loop { body, continuing, .. } => leaves(body, false) || leaves(continuing, false),
        _ => false,
    })
}
