//! Formulas on a line as MathML, which browsers set as mathematics.
//!
//! A line is written with the operators of the field: `a·b`, `a/b`, `x^y`, `x²`, `xᵢ`, `|x|` for a length, `⟨x⟩` for a vector that is normalised,
//! `f(x)`. A quotient is set as a fraction. Around ` / ` with spaces the whole terms are its parts; without them what stands next to it.
//! Words between formulas are set as text.

use maud::{Markup, PreEscaped, html};

/// What a line is made of.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    /// A name or a number.
    Name(String),
    /// A word of a sentence, or the id of a formula.
    Word(String),
    /// A superscript, written in ordinary characters.
    Above(String),
    /// A subscript, likewise.
    Below(String),
    /// Anything else.
    Sign(char),
    /// A quotient of whole terms.
    Wide,
}

/// Characters that are written higher, and what they stand for.
const ABOVE: &[(char, char)] = &[
    ('⁰', '0'),
    ('¹', '1'),
    ('²', '2'),
    ('³', '3'),
    ('⁴', '4'),
    ('⁵', '5'),
    ('⁶', '6'),
    ('⁷', '7'),
    ('⁸', '8'),
    ('⁹', '9'),
    ('⁻', '−'),
    ('ⁿ', 'n'),
    ('ᵏ', 'k'),
    ('ʲ', 'j'),
    ('ᵀ', 'T'),
];
/// Characters that are written lower.
const BELOW: &[(char, char)] = &[('ᵢ', 'i'), ('ₙ', 'n'), ('₀', '0'), ('₁', '1'), ('₂', '2')];
/// Names of more than one letter that are no words.
const NAMES: &[&str] = &[
    "max", "min", "clamp", "exp", "expm", "ln", "log", "mix", "round", "cos", "sin", "sqrt", "floor", "step", "CA",
    "CD", "CE", "CF", "CS", "LA", "LD", "LS", "MA", "MD", "MS", "FS", "Ip", "Ia", "Ib", "Lpos", "Vpos", "As", "Ad",
    "Cs", "Cd", "Cc", "Ac", "wa", "wb", "xa", "xb", "xp", "ox", "oy", "sx", "sy", "ka", "kc", "kd", "kl", "kq", "ks",
    "atten", "spot", "attr", "xyz", "color", "opacity", "depth", "byte", "texel", "src", "dst", "rgb", "alpha", "fs",
    "bits",
];
/// Families of formulas, whose ids may stand in a line.
const FAMILIES: &[&str] =
    &["lighting/", "attenuation/", "vector/", "fog/", "color/", "interpolation/", "depth/", "blend/"];

/// Characters of a line that are set in one row, at most, where it has parts.
const ROW: usize = 60;

/// A formula on a line, as mathematics. `names` are those of its inputs and outputs. The parts of a long line are set in rows of their own, so that it
/// fits where it stands.
#[must_use]
pub fn equation(text: &str, names: &[&str]) -> Markup {
    let rows = if text.chars().count() > ROW { parts(text) } else { vec![text] };
    html! { @for text in rows { (row(text, names)) } }
}

/// A line cut behind the commas and semicolons that stand in no brackets.
fn parts(text: &str) -> Vec<&str> {
    let (mut parts, mut from, mut depth) = (vec![], 0, 0);
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' | '⟨' => depth += 1,
            ')' | ']' | '}' | '⟩' => depth -= 1,
            ',' | ';' if depth == 0 && text[at + 1..].starts_with(' ') => {
                parts.push(text[from..=at].trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(text[from..].trim());
    parts
}

fn row(text: &str, names: &[&str]) -> Markup {
    let tokens = tokens(text, names);
    let mut parser = Parser { tokens: &tokens, at: 0, is_in_bars: false };
    let mut rows = String::new();
    while parser.at < tokens.len() {
        rows += &parser.row(&[]);
        // A bracket that closes nothing stands by itself.
        if let Some(Token::Sign(c)) = parser.tokens.get(parser.at) {
            rows += &operator(*c);
            parser.at += 1;
        }
    }
    html! { math display="block" { (PreEscaped(rows)) } }
}

fn lowered(table: &[(char, char)], c: char) -> Option<char> {
    table.iter().find_map(|&(from, to)| (from == c).then_some(to))
}

fn tokens(text: &str, names: &[&str]) -> Vec<Token> {
    let chars: Vec<char> = text.chars().collect();
    let (mut tokens, mut at) = (vec![], 0);
    let run = |from: usize, is_part: &dyn Fn(char) -> bool| chars[from..].iter().take_while(|c| is_part(**c)).count();
    while let Some(&c) = chars.get(at) {
        let rest: String = chars[at..].iter().collect();
        if let Some(family) = FAMILIES.iter().find(|family| rest.starts_with(**family)) {
            let count = family.len() + run(at + family.len(), &|c| c.is_ascii_alphanumeric() || c == '-');
            tokens.push(Token::Word(chars[at..at + count].iter().collect()));
            at += count;
        } else if c.is_ascii_digit() {
            let mut count = run(at, &|c| c.is_ascii_digit() || c == '.');
            if chars[at + count - 1] == '.' {
                count -= 1;
            }
            tokens.push(Token::Name(chars[at..at + count].iter().collect()));
            at += count;
        } else if is_letter(c) {
            let start = at;
            let count = run(at, &|c| is_letter(c) || c.is_ascii_digit() || c == '_');
            let mut word: String = chars[at..at + count].iter().collect();
            at += count;
            if chars.get(at) == Some(&'′') {
                word.push('′');
                at += 1;
            }
            let is_article = word == "a" && is_article(&chars[at..]);
            let is_variable = word.chars().count() == 1 && !is_article;
            // What has an index, a power or a digit is no word of a sentence.
            let is_scripted = chars.get(at).is_some_and(|&c| lowered(ABOVE, c).or(lowered(BELOW, c)).is_some());
            let is_marked = is_scripted || word.contains(['′', '_']) || word.ends_with(|c: char| c.is_ascii_digit());
            let is_known = NAMES.contains(&word.as_str()) || names.contains(&word.as_str());
            // What an operator stands next to is an operand of it.
            let is_operand = chars[..start].last().is_some_and(is_joining) || chars.get(at).is_some_and(is_joining);
            // "light's" is a word, though "light" is a name.
            let is_genitive = chars[at..].starts_with(&['\'', 's']);
            if is_genitive {
                word.push_str("'s");
                at += 2;
            }
            let is_name = !is_genitive && (is_variable || is_marked || is_operand || is_known && !is_article);
            tokens.push(if is_name { Token::Name(word) } else { Token::Word(word) });
        } else if rest.starts_with(" / ") {
            tokens.push(Token::Wide);
            at += 3;
        } else if lowered(ABOVE, c).is_some() || lowered(BELOW, c).is_some() {
            let table = if lowered(ABOVE, c).is_some() { ABOVE } else { BELOW };
            let count = run(at, &|c| lowered(table, c).is_some());
            let word = chars[at..at + count].iter().filter_map(|&c| lowered(table, c)).collect();
            tokens.push(if std::ptr::eq(table, ABOVE) { Token::Above(word) } else { Token::Below(word) });
            at += count;
        } else {
            // What stands between two words is part of the sentence.
            if c != ' ' {
                tokens.push(Token::Sign(c));
            }
            at += 1;
        }
    }
    tokens
}

fn is_letter(c: char) -> bool {
    c != 'Σ' && c.is_alphabetic() && lowered(ABOVE, c).is_none() && lowered(BELOW, c).is_none()
}

/// Whether a sign joins what stands next to it without a space.
const fn is_joining(sign: &char) -> bool {
    matches!(sign, '·' | '/' | '^')
}

/// Whether "a" is the article: a word of at least two letters follows it.
fn is_article(rest: &[char]) -> bool {
    rest.first() == Some(&' ')
        && rest.get(1).is_some_and(|c| is_letter(*c))
        && rest.get(2).is_some_and(|c| is_letter(*c))
}

struct Parser<'a> {
    tokens: &'a [Token],
    at: usize,
    /// Whether the innermost brackets are the bars of a length, so that the next bar closes them.
    is_in_bars: bool,
}

/// Signs between terms, which no fraction reaches across.
const BETWEEN: &[char] = &['=', ',', ';', '+', '−', '-', '≤', '≥', '<', '>', '×', ':', '…', '≈', '→', '±'];

impl Parser<'_> {
    fn sign(&self) -> Option<char> {
        match self.tokens.get(self.at) {
            Some(Token::Sign(c)) => Some(*c),
            _ => None,
        }
    }

    /// All up to a closing sign, which is left.
    fn row(&mut self, closing: &[char]) -> String {
        let mut whole = String::new();
        while self.at < self.tokens.len()
            && !self.sign().is_some_and(|c| closing.contains(&c) || (c == ')' || c == '⟩'))
        {
            let before = self.at;
            whole += &self.term(closing);
            match (self.tokens.get(self.at), self.sign()) {
                (_, Some(c)) if closing.contains(&c) => {}
                (_, Some(c)) if BETWEEN.contains(&c) => {
                    whole += &operator(c);
                    self.at += 1;
                }
                (Some(Token::Word(_)), _) => whole += &self.words(),
                _ if self.at == before => break,
                _ => {}
            }
        }
        whole
    }

    /// Words, one after the other, as one text.
    fn words(&mut self) -> String {
        let mut words = vec![];
        while let Some(Token::Word(word)) = self.tokens.get(self.at) {
            words.push(word.clone());
            self.at += 1;
        }
        html! { mtext { "\u{a0}" (words.join(" ")) "\u{a0}" } }.into_string()
    }

    /// A chain of factors, and a quotient of two such chains.
    fn term(&mut self, closing: &[char]) -> String {
        let over = self.chain(closing);
        if self.tokens.get(self.at) != Some(&Token::Wide) {
            return over;
        }
        self.at += 1;
        let under = self.chain(closing);
        format!("<mfrac><mrow>{over}</mrow><mrow>{under}</mrow></mfrac>")
    }

    fn chain(&mut self, closing: &[char]) -> String {
        let mut chain = String::new();
        loop {
            match self.sign() {
                Some(c) if closing.contains(&c) || BETWEEN.contains(&c) || c == ')' || c == '⟩' => {
                    // A sign in front of a term is its own.
                    if chain.is_empty() && (c == '−' || c == '±') && !closing.contains(&c) {
                        chain += &operator(c);
                        self.at += 1;
                        continue;
                    }
                    return chain;
                }
                // A sum is over all that follows, and so in no numerator.
                Some(c @ ('·' | '*' | 'Σ')) => {
                    chain += &operator(if c == '*' { '∗' } else { c });
                    self.at += 1;
                }
                None if !matches!(self.tokens.get(self.at), Some(Token::Name(_))) => return chain,
                sign => {
                    let before = self.at;
                    chain += &self.quotient();
                    // A sign of another kind stands for itself.
                    if let Some(c) = sign.filter(|_| self.at == before) {
                        chain += &operator(c);
                        self.at += 1;
                    }
                }
            }
        }
    }

    /// Factors that stand side by side, and what they are divided by.
    fn quotient(&mut self) -> String {
        let mut over = vec![];
        while let Some(factor) = self.factor() {
            over.push(factor);
        }
        if self.sign() != Some('/') {
            return over.iter().map(Factor::whole).collect();
        }
        self.at += 1;
        let under = self.factor();
        let over = match over.as_slice() {
            [one] => one.bare().to_owned(),
            several => several.iter().map(Factor::whole).collect(),
        };
        let under = under.map_or_else(String::new, |under| under.bare().to_owned());
        let fraction = format!("<mfrac><mrow>{over}</mrow><mrow>{under}</mrow></mfrac>");
        // `a/b/c` is a quotient of a quotient.
        if self.sign() != Some('/') {
            return fraction;
        }
        self.at += 1;
        let next = self.factor().map_or_else(String::new, |next| next.bare().to_owned());
        format!("<mfrac><mrow>{fraction}</mrow><mrow>{next}</mrow></mfrac>")
    }

    fn factor(&mut self) -> Option<Factor> {
        let mut factor = match self.tokens.get(self.at)? {
            Token::Name(name) => {
                self.at += 1;
                let name = named(name);
                match self.sign() {
                    Some('(') => {
                        let inner = self.fenced('(', ')');
                        Factor { text: format!("<mrow>{name}<mo>&#x2061;</mo>{}</mrow>", inner.text), inner: None }
                    }
                    _ => Factor { text: name, inner: None },
                }
            }
            Token::Sign('(') => self.fenced('(', ')'),
            Token::Sign('⟨') => self.fenced('⟨', '⟩'),
            Token::Sign('|') if !self.is_in_bars => self.fenced('|', '|'),
            Token::Sign('√') => {
                self.at += 1;
                let under = self.factor()?;
                Factor { text: format!("<msqrt>{}</msqrt>", under.bare()), inner: None }
            }
            Token::Sign(c @ ('½' | '¼' | '∞' | '′')) => {
                self.at += 1;
                let text = match c {
                    '½' => "<mfrac><mn>1</mn><mn>2</mn></mfrac>".to_owned(),
                    '¼' => "<mfrac><mn>1</mn><mn>4</mn></mfrac>".to_owned(),
                    c => operator(*c),
                };
                Factor { text, inner: None }
            }
            _ => return None,
        };
        loop {
            match self.tokens.get(self.at) {
                Some(Token::Below(below)) => {
                    self.at += 1;
                    factor = factor.scripted("msub", &named(below));
                }
                Some(Token::Above(above)) => {
                    self.at += 1;
                    let above =
                        above.strip_prefix('−').map_or_else(|| named(above), |rest| operator('−') + &named(rest));
                    factor = factor.scripted("msup", &above);
                }
                Some(Token::Sign('^')) => {
                    self.at += 1;
                    let above = self.factor().map_or_else(String::new, |above| above.bare().to_owned());
                    factor = factor.scripted("msup", &above);
                }
                _ => return Some(factor),
            }
        }
    }

    /// What stands between two brackets.
    fn fenced(&mut self, open: char, close: char) -> Factor {
        self.at += 1;
        let was_in_bars = std::mem::replace(&mut self.is_in_bars, open == '|');
        let start = self.at;
        let mut inner = self.row(&[close]);
        // What is left is shown as it stands.
        while self.at < self.tokens.len() && self.sign() != Some(close) {
            inner += &match &self.tokens[self.at] {
                Token::Sign(c) => operator(*c),
                Token::Name(text) | Token::Above(text) | Token::Below(text) | Token::Word(text) => named(text),
                Token::Wide => operator('/'),
            };
            self.at += 1;
        }
        // A product of names side by side, such as the triple product (a b c), is written with its brackets.
        let is_of_names = self
            .tokens
            .get(start..self.at)
            .is_some_and(|all| all.len() > 1 && all.iter().all(|t| matches!(t, Token::Name(_))));
        self.is_in_bars = was_in_bars;
        self.at += 1;
        let fence = |c: char| html! { mo stretchy="true" fence="true" { (c) } }.into_string();
        Factor {
            text: format!("<mrow>{}{inner}{}</mrow>", fence(open), fence(close)),
            inner: (open == '(' && !is_of_names).then_some(inner),
        }
    }
}

/// A factor, and what stands in its round brackets where it is nothing else.
struct Factor {
    text: String,
    inner: Option<String>,
}

impl Factor {
    fn whole(&self) -> String {
        self.text.clone()
    }

    /// Without brackets, where a fraction's bar or a root stands for them.
    fn bare(&self) -> &str {
        self.inner.as_deref().unwrap_or(&self.text)
    }

    fn scripted(&self, element: &str, script: &str) -> Self {
        Self { text: format!("<{element}>{}<mrow>{script}</mrow></{element}>", self.text), inner: None }
    }
}

fn named(name: &str) -> String {
    if name.starts_with(|c: char| c.is_ascii_digit()) {
        return html! { mn { (name) } }.into_string();
    }
    // `w_min` has its end below.
    match name.split_once('_') {
        Some((name, below)) if name.chars().count() == 1 => {
            html! { msub { mi { (name) } mi { (below) } } }.into_string()
        }
        _ => html! { mi { (name) } }.into_string(),
    }
}

fn operator(c: char) -> String {
    html! { mo { (c) } }.into_string()
}

#[cfg(test)]
mod tests {
    use super::equation;

    fn set(text: &str) -> String {
        equation(text, &["density", "dmin", "dmax", "fog", "shaded"]).0.replace("<mrow>", "").replace("</mrow>", "")
    }

    #[test]
    fn the_parts_of_a_long_line_are_rows_of_their_own() {
        let rows = |text: &str| equation(text, &[]).0.matches("<math").count();
        assert_eq!(rows("CF = LA*MA + LD*MD·max(l·n, 0) + LS*MS·max(n·h, 0)^shininess, everything normalised"), 2);
        assert_eq!(rows("r = i − 2(i·n)n, i = −l"), 1, "a short line is one row");
        assert_eq!(
            rows("f(a, b, c) = (a, b, c) + (a, b, c) + (a, b, c) + (a, b, c) + (a, b, c)"),
            1,
            "brackets are not cut"
        );
    }

    #[test]
    fn quotients_are_fractions_of_what_stands_next_or_of_whole_terms() {
        assert!(set("z/w·n").contains("<mfrac><mi>z</mi><mi>w</mi></mfrac><mo>·</mo><mi>n</mi>"), "{}", set("z/w·n"));
        let whole = set("a·b / (c + d²)");
        assert!(whole.contains("<mfrac><mi>a</mi><mo>·</mo><mi>b</mi>"), "{whole}");
        let bare = set("(a + b)/(c − d)");
        assert!(bare.contains("<mfrac><mi>a</mi><mo>+</mo><mi>b</mi><mi>c</mi><mo>−</mo><mi>d</mi></mfrac>"), "{bare}");
    }

    #[test]
    fn powers_lengths_and_words_are_set() {
        let fog = set("f = clamp(exp(−(density·z)²), 0, 1); color = mix(fog, shaded, f)");
        assert!(fog.contains("<msup>") && fog.contains("<mn>2</mn></msup>"), "{fog}");
        let spot = set("spot = max(−l·axis, 0)^e within the cone, else 0");
        assert!(
            spot.contains("<mtext>\u{a0}within the cone\u{a0}</mtext>") && spot.contains("<mi>e</mi></msup>"),
            "{spot}"
        );
        let article = equation("f = a·x within a cone", &["a"]).0;
        assert!(article.contains("<mi>a</mi>") && article.contains("a cone"), "{article}");
        let mark = set("a < b");
        assert!(mark.contains("<mo>&lt;</mo>"), "{mark}");
    }

    #[test]
    fn bars_close_and_what_follows_them_is_outside() {
        let bars = |inner: &str| {
            let fence = "<mo stretchy=\"true\" fence=\"true\">|</mo>";
            format!("{fence}{inner}{fence}")
        };
        let square = set("exp(−(density·|p|)²)");
        assert!(square.contains(&bars("<mi>p</mi>")), "{square}");
        assert!(square.contains(")</mo><mn>2</mn></msup>"), "{square}");
        let under = set("v/|v|, 0 for the zero vector");
        assert!(under.contains(&format!("{}</mfrac><mo>,</mo>", bars("<mi>v</mi>"))), "{under}");
        let nested = set("|(a − p)·b|·c");
        assert!(nested.ends_with("|</mo><mo>·</mo><mi>c</mi></math>"), "{nested}");
        let within = set("|a·(|b| + c)|");
        assert_eq!(within.matches("|</mo>").count(), 4, "{within}");
    }

    #[test]
    fn brackets_that_never_close_are_set_as_they_stand() {
        for text in ["((a", "|(a", "(|a b", "⟨(", "|"] {
            assert!(set(text).starts_with("<math"), "{text}");
        }
    }

    #[test]
    fn a_sum_is_over_whole_quotients() {
        let sum = set("Σ λᵢ·aᵢ/wᵢ / Σ λᵢ/wᵢ");
        let quotient = |name: &str| {
            format!("<mfrac><msub><mi>{name}</mi><mi>i</mi></msub><msub><mi>w</mi><mi>i</mi></msub></mfrac>")
        };
        assert!(sum.contains(&format!("<mo>Σ</mo>{}</mfrac></math>", quotient("λ"))), "{sum}");
        assert!(sum.contains(&format!("<mo>·</mo>{}<mo>Σ</mo>", quotient("a"))), "{sum}");
    }

    #[test]
    fn words_next_to_an_operator_are_its_operands() {
        let words = set("n′ = cofactors·n/determinant, the fog's density");
        assert!(words.contains("<mfrac><mi>n</mi><mi>determinant</mi></mfrac>"), "{words}");
        assert!(words.contains("the fog's") && words.contains("<mi>density</mi>"), "{words}");
        let triple = set("(a b p)/(a b c)");
        assert_eq!(triple.matches("(</mo>").count(), 2, "{triple}");
    }
}
