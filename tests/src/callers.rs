//! Which functions of the shaders call which.

use crate::mutants::tokens::{TokenKind, tokens};
use lightmeter_gpu::Shaders;
use std::collections::BTreeSet;

/// The functions that call some, by way of others too, and these themselves. Of what stands outside of functions, which has no name,
/// every one.
#[must_use]
pub fn callers<'a>(shaders: &Shaders, functions: impl IntoIterator<Item = &'a str>) -> BTreeSet<String> {
    let calls: Vec<(String, String)> = shaders.texts().flat_map(|(_, text)| calls(text)).collect();
    let mut found: BTreeSet<String> = functions.into_iter().map(str::to_owned).collect();
    if found.contains("") {
        return calls.into_iter().map(|(caller, _)| caller).collect();
    }
    loop {
        let before = found.len();
        let more = calls.iter().filter(|(_, called)| found.contains(called)).map(|(caller, _)| caller.clone());
        found.extend(more.collect::<Vec<String>>());
        if found.len() == before {
            return found;
        }
    }
}

/// Each function of a text with each that it calls, and with itself.
fn calls(text: &str) -> Vec<(String, String)> {
    let tokens = tokens(text);
    let word = |at: usize| tokens.get(at).map_or("", |token| &text[token.range.clone()]);
    let (mut found, mut function) = (vec![], "");
    for (at, token) in tokens.iter().enumerate() {
        if word(at) == "fn" {
            function = word(at + 1);
        }
        if token.kind == TokenKind::Word && word(at + 1) == "(" && !function.is_empty() {
            found.push((function.to_owned(), word(at).to_owned()));
        }
    }
    found
}
