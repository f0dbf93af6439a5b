//! Conditions on effects: read once, decided where the effects are known, and written as WGSL where switches decide.

use std::collections::BTreeMap;

/// What a name stands for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Truth {
    /// It is known.
    Known(bool),
    /// A uniform switch decides: the WGSL expression.
    Switched(String),
}

/// A condition.
#[derive(Clone, Debug)]
pub(super) enum Condition {
    Name(String),
    Not(Box<Self>),
    Any(Vec<Self>),
    All(Vec<Self>),
}

/// Conditions with a name.
pub(super) type Named = BTreeMap<String, Condition>;

impl Condition {
    /// Reads one.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let mut tokens = tokens(text);
        let condition = any(&mut tokens)?;
        match tokens.pop() {
            None => Ok(condition),
            Some(token) => Err(format!("`{token}` is out of place in the condition `{text}`")),
        }
    }

    /// Its truth, names read by `of`, those with a condition of their own looked up.
    ///
    /// # Errors
    /// Where a name is unknown.
    pub(super) fn truth(&self, named: &Named, of: &dyn Fn(&str) -> Option<Truth>) -> Result<Truth, String> {
        match self {
            Self::Name(name) => match named.get(name) {
                Some(condition) => condition.truth(named, of),
                None => of(name).ok_or_else(|| format!("`{name}` is no effect, stage or name of a condition")),
            },
            Self::Not(condition) => Ok(match condition.truth(named, of)? {
                Truth::Known(is) => Truth::Known(!is),
                Truth::Switched(text) => Truth::Switched(format!("!({text})")),
            }),
            Self::Any(parts) => combined(parts, true, " || ", named, of),
            Self::All(parts) => combined(parts, false, " && ", named, of),
        }
    }
}

/// Parts of which one that equals `decisive` decides.
fn combined(
    parts: &[Condition],
    decisive: bool,
    operator: &str,
    named: &Named,
    of: &dyn Fn(&str) -> Option<Truth>,
) -> Result<Truth, String> {
    let mut texts = vec![];
    let mut decided = false;
    for part in parts {
        match part.truth(named, of)? {
            Truth::Known(is) => decided |= is == decisive,
            Truth::Switched(text) => texts.push(text),
        }
    }
    Ok(match (decided, texts.len()) {
        (true, _) => Truth::Known(decisive),
        (false, 0) => Truth::Known(!decisive),
        (false, 1) => Truth::Switched(texts.remove(0)),
        (false, _) => Truth::Switched(format!("({})", texts.join(operator))),
    })
}

/// The tokens, last first.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens: Vec<String> = vec![];
    let mut in_name = false;
    for c in text.chars() {
        let is_name = c.is_ascii_alphanumeric() || c == '_';
        match tokens.last_mut() {
            Some(last) if is_name && in_name => last.push(c),
            _ if !c.is_whitespace() => tokens.push(c.into()),
            _ => {}
        }
        in_name = is_name;
    }
    tokens.reverse();
    tokens
}

fn any(tokens: &mut Vec<String>) -> Result<Condition, String> {
    let mut parts = vec![all(tokens)?];
    while tokens.last().is_some_and(|token| token == "|") {
        tokens.pop();
        parts.push(all(tokens)?);
    }
    Ok(Condition::Any(parts))
}

fn all(tokens: &mut Vec<String>) -> Result<Condition, String> {
    let mut parts = vec![one(tokens)?];
    while tokens.last().is_some_and(|token| token == "&") {
        tokens.pop();
        parts.push(one(tokens)?);
    }
    Ok(Condition::All(parts))
}

fn one(tokens: &mut Vec<String>) -> Result<Condition, String> {
    let token = tokens.pop().ok_or("a condition ends too soon")?;
    match token.as_str() {
        "!" => Ok(Condition::Not(Box::new(one(tokens)?))),
        "(" => {
            let inner = any(tokens)?;
            if tokens.pop().is_some_and(|token| token == ")") { Ok(inner) } else { Err("a `)` is missing".into()) }
        }
        name if name.starts_with(|c: char| c.is_ascii_alphabetic()) => Ok(Condition::Name(token)),
        other => Err(format!("`{other}` is out of place in a condition")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(text: &str) -> Result<Truth, String> {
        let named = Named::from([("both".to_owned(), Condition::parse("yes & maybe").expect("it is read"))]);
        Condition::parse(text)?.truth(&named, &|name| match name {
            "yes" => Some(Truth::Known(true)),
            "no" => Some(Truth::Known(false)),
            "maybe" => Some(Truth::Switched("m".into())),
            _ => None,
        })
    }

    #[test]
    fn conditions_are_decided_as_far_as_they_can_be() {
        let switched = |text: &str| Ok(Truth::Switched(text.into()));
        for (text, wanted) in [
            ("yes | maybe", Ok(Truth::Known(true))),
            ("no | maybe", switched("m")),
            ("no & maybe", Ok(Truth::Known(false))),
            ("both", switched("m")),
            ("!(yes & maybe)", switched("!(m)")),
            ("!no & !yes", Ok(Truth::Known(false))),
            ("maybe | no & yes", switched("m")),
            ("maybe & both", switched("(m && m)")),
        ] {
            assert_eq!(truth(text), wanted, "{text}");
        }
    }

    #[test]
    fn what_cannot_be_read_is_said() {
        for text in ["", "yes |", "(yes", "yes yes", "nothing", "yes ^ no"] {
            assert!(truth(text).is_err(), "{text}");
        }
    }
}
