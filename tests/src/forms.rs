//! The built-in shaders with a built-in function or an operation of theirs put another way, in which a shader compiler may put it.
//!
//! WGSL says of most built-in functions by what expression their accuracy is bounded, not how they are computed, and lets a compiler
//! contract a product and a sum. Drivers differ in which form they take. Here every place of a text takes the same other form, as if a
//! driver took it; what was right stays right.

use lightmeter_gpu::{GpuError, Shaders};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{BinaryOperator, Expression, Function, Handle, MathFunction, Module, TypeInner};
use std::collections::BTreeSet;
use std::ops::Range;

/// The files of formulas, and those that they call.
pub const FORMULA_FILES: [&str; 11] = [
    "elementary.wgsl",
    "vector.wgsl",
    "interpolation.wgsl",
    "color.wgsl",
    "attenuation.wgsl",
    "lighting.wgsl",
    "fog.wgsl",
    "depth.wgsl",
    "blend.wgsl",
    "texture.wgsl",
    "technique.wgsl",
];

/// An argument of what is put another way.
#[derive(Clone, Debug)]
pub struct Argument {
    /// In parentheses.
    text: String,
    /// 1 of a scalar; of a matrix, its columns.
    size: usize,
}

/// What is put another way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operation {
    /// A call of a built-in function.
    Call(MathFunction),
    /// a / b.
    Quotient,
    /// A product and a sum or a difference, with the sign of each; of two products the one after the sign.
    ProductAndSum,
    /// The same, of two products the one before the sign.
    SumOfProducts,
    /// A matrix times a vector.
    Transform,
}

/// Another form of an operation.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// As reports name it.
    pub name: &'static str,
    operation: Operation,
    /// Puts it so: the arguments, and the size of the result.
    put: fn(&[Argument], usize) -> String,
}

macro_rules! forms {
    ($($name:literal, $operation:expr => |$x:ident, $size:ident| $put:expr;)*) => {
        /// Every form.
        pub const FORMS: [Form; [$($name),*].len()] =
            [$(Form { name: $name, operation: $operation, put: |$x, $size| $put }),*];
    };
}

forms! {
    "mix by weights", Operation::Call(MathFunction::Mix) => |x, _size|
        format!("({a} * (1.0 - {t}) + {b} * {t})", a = x[0].text, b = x[1].text, t = x[2].text);
    "mix from the first", Operation::Call(MathFunction::Mix) => |x, _size|
        format!("({a} + {t} * ({b} - {a}))", a = x[0].text, b = x[1].text, t = x[2].text);
    "mix by weights, contracted", Operation::Call(MathFunction::Mix) => |x, size| {
        let t = splat(&x[2], size);
        format!("fma({b}, {t}, {a} * (1.0 - {t}))", a = x[0].text, b = x[1].text)
    };
    "mix from the first, contracted", Operation::Call(MathFunction::Mix) => |x, size|
        format!("fma({t}, {b} - {a}, {a})", a = x[0].text, b = x[1].text, t = splat(&x[2], size));
    "normalize by the length", Operation::Call(MathFunction::Normalize) => |x, _size|
        format!("({v} / sqrt(dot({v}, {v})))", v = x[0].text);
    "normalize by the inverse root", Operation::Call(MathFunction::Normalize) => |x, _size|
        format!("({v} * inverseSqrt(dot({v}, {v})))", v = x[0].text);
    "normalize by the reciprocal length", Operation::Call(MathFunction::Normalize) => |x, _size|
        format!("({v} * (1.0 / sqrt(dot({v}, {v}))))", v = x[0].text);
    "length by dot", Operation::Call(MathFunction::Length) => |x, _size| format!("sqrt(dot({v}, {v}))", v = x[0].text);
    "length by the inverse root", Operation::Call(MathFunction::Length) => |x, _size|
        format!("(1.0 / inverseSqrt(dot({v}, {v})))", v = x[0].text);
    "distance by length", Operation::Call(MathFunction::Distance) => |x, _size|
        format!("length({} - {})", x[0].text, x[1].text);
    "dot from the last", Operation::Call(MathFunction::Dot) => |x, _size| {
        let product = |c: char| format!("{}.{c} * {}.{c}", x[0].text, x[1].text);
        components(x[0].size).rev().map(product).reduce(|sum, more| format!("({sum} + {more})")).unwrap_or_default()
    };
    "dot contracted from the first", Operation::Call(MathFunction::Dot) => |x, _size| contracted_dot(x, components(x[0].size));
    "dot contracted from the last", Operation::Call(MathFunction::Dot) => |x, _size| contracted_dot(x, components(x[0].size).rev());
    "cross by components", Operation::Call(MathFunction::Cross) => |x, _size| cross(x, |[a, b], [c, d]| format!("{a} * {b} - {c} * {d}"));
    "cross contracted", Operation::Call(MathFunction::Cross) => |x, _size| cross(x, |[a, b], [c, d]| format!("fma({a}, {b}, -({c} * {d}))"));
    "cross contracted the other way", Operation::Call(MathFunction::Cross) => |x, _size|
        cross(x, |[a, b], [c, d]| format!("fma(-{c}, {d}, {a} * {b})"));
    "pow by exp2 and log2", Operation::Call(MathFunction::Pow) => |x, _size| format!("exp2({} * log2({}))", x[1].text, x[0].text);
    "exp by exp2", Operation::Call(MathFunction::Exp) => |x, _size| format!("exp2({} * 1.44269504)", x[0].text);
    "clamp from below first", Operation::Call(MathFunction::Clamp) => |x, _size|
        format!("min(max({}, {}), {})", x[0].text, x[1].text, x[2].text);
    "clamp from above first", Operation::Call(MathFunction::Clamp) => |x, _size|
        format!("max(min({}, {}), {})", x[0].text, x[2].text, x[1].text);
    "saturate by clamp", Operation::Call(MathFunction::Saturate) => |x, size| {
        let [zero, one] = ["0.0", "1.0"].map(|value| splat(&Argument { text: value.into(), size: 1 }, size));
        format!("clamp({}, {zero}, {one})", x[0].text)
    };
    "abs by max", Operation::Call(MathFunction::Abs) => |x, _size| format!("max({x}, -{x})", x = x[0].text);
    "quotient by the reciprocal", Operation::Quotient => |x, _size| format!("({} * (1.0 / {}))", x[0].text, x[1].text);
    "product and sum contracted", Operation::ProductAndSum => |x, size|
        format!("fma({}, {}, {})", splat(&x[0], size), splat(&x[1], size), splat(&x[2], size));
    "sum of products contracted in the first", Operation::SumOfProducts => |x, size|
        format!("fma({}, {}, {})", splat(&x[0], size), splat(&x[1], size), splat(&x[2], size));
    "transform from the last column", Operation::Transform => |x, _size| {
        let column = |(k, c): (usize, char)| format!("{}[{k}] * {}.{c}", x[0].text, x[1].text);
        let columns: Vec<String> = components(x[0].size).enumerate().map(column).collect();
        columns.into_iter().rev().reduce(|sum, more| format!("({sum} + {more})")).unwrap_or_default()
    };
    "transform contracted", Operation::Transform => |x, size| {
        let of = |c: char| splat(&Argument { text: format!("{}.{c}", x[1].text), size: 1 }, size);
        let first = format!("({}[0] * {})", x[0].text, of('x'));
        let more = |sum: String, (k, c): (usize, char)| format!("fma({}[{k}], {}, {sum})", x[0].text, of(c));
        components(x[0].size).enumerate().skip(1).fold(first, more)
    };
}

fn components(size: usize) -> impl DoubleEndedIterator<Item = char> + ExactSizeIterator {
    ['x', 'y', 'z', 'w'].into_iter().take(size)
}

/// An argument of the size of a result. Numbers stand for vectors too.
fn splat(argument: &Argument, size: usize) -> String {
    let is_number = argument
        .text
        .trim_matches(|c: char| c.is_whitespace() || "(-)".contains(c))
        .starts_with(|c: char| c.is_ascii_digit());
    if (argument.size == 1 || is_number) && size > 1 {
        format!("vec{size}f({})", argument.text)
    } else {
        argument.text.clone()
    }
}

fn contracted_dot(x: &[Argument], mut order: impl Iterator<Item = char>) -> String {
    let first = order.next().map(|c| format!("({}.{c} * {}.{c})", x[0].text, x[1].text));
    order.fold(first.unwrap_or_default(), |sum, c| format!("fma({}.{c}, {}.{c}, {sum})", x[0].text, x[1].text))
}

/// A cross product of which each component is a difference of two products, each of which has two factors.
fn cross(x: &[Argument], difference: fn([String; 2], [String; 2]) -> String) -> String {
    let component = |[i, j]: [char; 2]| {
        let of = |side: usize, c: char| format!("{}.{c}", x[side].text);
        difference([of(0, i), of(1, j)], [of(0, j), of(1, i)])
    };
    let parts = [['y', 'z'], ['z', 'x'], ['x', 'y']].map(component);
    format!("vec3f({})", parts.join(", "))
}

/// A place in a text that is put another way.
struct Place {
    /// The function that it is in.
    function: String,
    range: Range<usize>,
    size: usize,
    /// Each with what stands before it, and its size.
    arguments: Vec<(&'static str, Range<usize>, usize)>,
}

/// The built-in shaders with every place of an operation in a form, and the functions that have such a place.
///
/// # Errors
/// Where they are invalid so, which a test rules out.
pub fn in_form(shaders: &Shaders, form: &Form) -> Result<(Shaders, BTreeSet<String>), GpuError> {
    let texts: Vec<(&str, &str)> =
        FORMULA_FILES.iter().filter_map(|file| shaders.texts().find(|(name, _)| name == file)).collect();
    let whole: String = texts.iter().map(|(_, text)| *text).collect();
    let places = sorted(places(&whole, form.operation));
    let (mut put, mut start) = (shaders.clone(), 0);
    for (name, text) in texts {
        let end = start + text.len();
        let written = written(&whole, start..end, &places, form);
        if written != text {
            put = put.with(name, written)?;
        }
        start = end;
    }
    Ok((put, places.into_iter().map(|place| place.function).collect()))
}

/// Places from the left to the right, one that holds another before it.
fn sorted(mut places: Vec<Place>) -> Vec<Place> {
    places.sort_by_key(|place| (place.range.start, std::cmp::Reverse(place.range.end)));
    places
}

/// A range of a text with the places in it put another way.
fn written(text: &str, range: Range<usize>, places: &[Place], form: &Form) -> String {
    let (mut out, mut at) = (String::new(), range.start);
    for place in places {
        if place.range.start < at || place.range.end > range.end {
            continue;
        }
        out += &text[at..place.range.start];
        let argument = |(sign, part, size): &(&'static str, Range<usize>, usize)| Argument {
            text: format!("({sign}({}))", written(text, part.clone(), places, form)),
            size: *size,
        };
        let arguments: Vec<Argument> = place.arguments.iter().map(argument).collect();
        out += &(form.put)(&arguments, place.size);
        at = place.range.end;
    }
    out + &text[at..range.end]
}

/// Every place of an operation in a text.
fn places(text: &str, operation: Operation) -> Vec<Place> {
    let module = naga::front::wgsl::parse_str(text).expect("the formulas' files are valid together");
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(&module).expect("the formulas' files are valid together");
    let mut places = vec![];
    for (of, function) in module.functions.iter() {
        let found = Found { text, module: &module, info: &info, of, function };
        places.extend(function.expressions.iter().filter_map(|(at, _)| found.place(at, operation)));
    }
    places
}

/// A function, to look at its expressions.
struct Found<'a> {
    text: &'a str,
    module: &'a Module,
    info: &'a ModuleInfo,
    of: Handle<Function>,
    function: &'a Function,
}

impl Found<'_> {
    fn inner(&self, at: Handle<Expression>) -> &TypeInner {
        self.info[self.of][at].ty.inner_with(&self.module.types)
    }

    /// 1 of a scalar, the components of a vector, the columns of a matrix; `None` of what has no float components.
    fn size(&self, at: Handle<Expression>) -> Option<usize> {
        match *self.inner(at) {
            TypeInner::Scalar(scalar) if scalar.kind == naga::ScalarKind::Float => Some(1),
            TypeInner::Vector { size, scalar } if scalar.kind == naga::ScalarKind::Float => Some(size as usize),
            TypeInner::Matrix { columns, .. } => Some(columns as usize),
            _ => None,
        }
    }

    /// Where an expression stands. Of a call, the module knows the function's name alone.
    fn range(&self, at: Handle<Expression>) -> Option<Range<usize>> {
        let range = self.function.expressions.get_span(at).to_range()?;
        let is_name = self.text[range.clone()].chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if is_name && self.text[range.end..].starts_with('(') {
            return Some(range.start..call(self.text, range.end)?.1 + 1);
        }
        Some(range)
    }

    /// The operands of a binary operation as they stand there: of a value that has a name, its name.
    fn operands(&self, at: Handle<Expression>) -> Option<[Range<usize>; 2]> {
        let whole = self.range(at)?;
        let operator = whole.start + last_operator(&self.text[whole.clone()])?;
        Some([whole.start..operator, operator + 1..whole.end])
    }

    fn is_matrix(&self, at: Handle<Expression>) -> bool {
        matches!(self.inner(at), TypeInner::Matrix { .. })
    }

    fn product(&self, at: Handle<Expression>) -> Option<[Handle<Expression>; 2]> {
        match self.function.expressions[at] {
            Expression::Binary { op: BinaryOperator::Multiply, left, right }
                if !self.is_matrix(left) && !self.is_matrix(right) =>
            {
                Some([left, right])
            }
            _ => None,
        }
    }

    /// An expression that is an operation, as the place that it is.
    fn place(&self, at: Handle<Expression>, operation: Operation) -> Option<Place> {
        let arguments = match (&self.function.expressions[at], operation) {
            (&Expression::Math { fun, arg, arg1, arg2, .. }, Operation::Call(wanted)) if fun == wanted => {
                let name = self.function.expressions.get_span(at).to_range()?;
                let (texts, _) = call(self.text, name.end)?;
                let sizes = [Some(arg), arg1, arg2].into_iter().flatten().map(|one| self.size(one));
                texts.into_iter().zip(sizes).map(|(text, size)| Some(("", text, size?))).collect::<Option<_>>()?
            }
            (&Expression::Binary { op, left, right }, _) => {
                let is_transform = op == BinaryOperator::Multiply && self.is_matrix(left) && !self.is_matrix(right);
                let is_it = match operation {
                    Operation::Quotient => op == BinaryOperator::Divide,
                    Operation::Transform => is_transform,
                    Operation::ProductAndSum => return self.contraction(at, op, [left, right], false),
                    Operation::SumOfProducts => return self.contraction(at, op, [left, right], true),
                    Operation::Call(_) => false,
                };
                let [first, second] = self.operands(at).filter(|_| is_it)?;
                vec![("", first, self.size(left)?), ("", second, self.size(right)?)]
            }
            _ => return None,
        };
        Some(Place { function: self.function.name.clone()?, range: self.range(at)?, size: self.size(at)?, arguments })
    }

    /// a·b + c, a·b − c and c − a·b with the arguments of fma, each with its sign.
    fn contraction(
        &self,
        at: Handle<Expression>,
        op: BinaryOperator,
        [left, right]: [Handle<Expression>; 2],
        in_the_first: bool,
    ) -> Option<Place> {
        let minus = match op {
            BinaryOperator::Add => "",
            BinaryOperator::Subtract => "-",
            _ => return None,
        };
        let [first, second] = self.operands(at)?;
        // A product that has a name stands elsewhere.
        let is_here = |one: Handle<Expression>, part: &Range<usize>| {
            self.product(one)
                .filter(|_| self.range(one).is_some_and(|range| part.start <= range.start && range.end <= part.end))
        };
        let (product, [a, b], signs, other) =
            match (is_here(right, &second).filter(|_| !in_the_first), is_here(left, &first)) {
                (Some(of), _) => (right, of, [minus, ""], (first, self.size(left)?)),
                (None, Some(of)) => (left, of, ["", minus], (second, self.size(right)?)),
                (None, None) => return None,
            };
        let [first, second] = self.operands(product)?;
        let arguments =
            vec![(signs[0], first, self.size(a)?), ("", second, self.size(b)?), (signs[1], other.0, other.1)];
        Some(Place { function: self.function.name.clone()?, range: self.range(at)?, size: self.size(at)?, arguments })
    }
}

/// The arguments of a call whose opening parenthesis stands at a place of a text, and where the closing one stands.
fn call(text: &str, open: usize) -> Option<(Vec<Range<usize>>, usize)> {
    let (mut depth, mut start, mut arguments) = (0, open + 1, vec![]);
    for (at, c) in text[open..].char_indices().map(|(at, c)| (open + at, c)) {
        match c {
            '(' => depth += 1,
            ')' if depth == 1 => {
                // A comma may follow the last argument.
                if !text[start..at].trim().is_empty() {
                    arguments.push(start..at);
                }
                return Some((arguments, at));
            }
            ')' => depth -= 1,
            ',' if depth == 1 => {
                arguments.push(start..at);
                start = at + 1;
            }
            _ => {}
        }
    }
    None
}

/// Where the operator of a binary operation stands in its text: of the last that is in no parentheses, since all that are as strong
/// or stronger stand before it or in its left operand.
fn last_operator(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let is_binary = |at: usize| {
        let before = text[..at].trim_end();
        let is_of_number = matches!(bytes[at], b'+' | b'-')
            && before.len() == at
            && before.ends_with(['e', 'p'])
            && before[..before.len() - 1].ends_with(|c: char| c.is_ascii_hexdigit() || c == '.');
        !is_of_number && before.ends_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | ')' | ']' | '.'))
    };
    let (mut depth, mut sum, mut product) = (0, None, None);
    for (at, byte) in bytes.iter().enumerate() {
        match byte {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth -= 1,
            b'+' | b'-' if depth == 0 && is_binary(at) => sum = Some(at),
            b'*' | b'/' if depth == 0 && is_binary(at) => product = Some(at),
            _ => {}
        }
    }
    sum.or(product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_operator_of_a_text_is_its_weakest_and_last() {
        for (text, at) in [
            ("a + b * c", 2),
            ("a * b - c", 6),
            ("a * (b - c)", 2),
            ("x[i + 1] / 2.0", 9),
            ("a * -b", 2),
            ("1e-5 * a", 5),
            ("0x1p-126 / a", 9),
            ("a - -b * 1e-5", 2),
            ("a / b / c", 6),
        ] {
            assert_eq!(last_operator(text), Some(at), "{text}");
        }
        assert_eq!(last_operator("-a"), None);
    }

    #[test]
    fn each_form_is_put_in_every_place_and_in_places_within_places() {
        let put = |name: &str, text: &str| {
            let form = FORMS.iter().find(|form| form.name == name).expect("there is one");
            let text = format!("fn f(a: vec3f, b: vec3f, m: mat2x2f, v: vec2f, t: f32) -> vec4f {{ {text} }}");
            let places = places(&text, form.operation);
            let put = written(&text, 0..text.len(), &sorted(places), form);
            naga::front::wgsl::parse_str(&put).unwrap_or_else(|error| panic!("{put}: {error}"));
            put.replace([' ', '('], "").replace(')', "")
        };
        for (name, text, expected) in [
            ("mix from the first", "return vec4f(mix(a, mix(a, b, t), t), 1.0);", "vec4fa+t*a+t*b-a-a,1.0;"),
            ("quotient by the reciprocal", "let c = t / 2.0; return vec4f(c / t / c);", "vec4fc*1.0/t*1.0/c;"),
            (
                "product and sum contracted",
                "let c = t * t; return vec4f(c - t * 2.0 + t * t);",
                "vec4ffmat,t,fma-t,2.0,c;",
            ),
            ("product and sum contracted", "return vec4f(t * a + b, 1.0);", "vec4ffmavec3ft,a,b,1.0;"),
            ("product and sum contracted", "return vec4f(a * t - 0.5, 1.0);", "vec4ffmaa,vec3ft,vec3f-0.5,1.0;"),
            ("sum of products contracted in the first", "return vec4f(t * 2.0 - t * a.x);", "vec4ffmat,2.0,-t*a.x;"),
            ("transform contracted", "return vec4f(m * v, v);", "vec4ffmam[1],vec2fv.y,m[0]*vec2fv.x,v;"),
        ] {
            let found = put(name, text);
            assert!(found.contains(expected), "{name}: {found}");
        }
    }
}
