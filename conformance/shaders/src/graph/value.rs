//! Values, and what operations make of them, in any precision.

use super::{Binary, Function, Op, Type};
use num_traits::Float;

/// Most components: a matrix of four columns and rows.
const MOST: usize = 16;

/// Components of a vector, or of a matrix column by column. Truth is 1, untruth 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value<N> {
    length: usize,
    components: [N; MOST],
}

impl<N: Float> Value<N> {
    /// Zeros.
    #[must_use]
    pub fn zero(length: usize) -> Self {
        Self { length: length.min(MOST), components: [N::zero(); MOST] }
    }

    /// Its components.
    #[must_use]
    pub fn components(&self) -> &[N] {
        &self.components[..self.length]
    }

    pub(crate) fn components_mut(&mut self) -> &mut [N] {
        &mut self.components[..self.length]
    }

    /// The first component.
    #[must_use]
    pub fn first(&self) -> N {
        self.components[0]
    }

    /// A component; a scalar has the same in all.
    fn at(&self, k: usize) -> N {
        if self.length == 1 { self.components[0] } else { self.components[k] }
    }

    /// Of each component another.
    #[must_use]
    pub fn map(mut self, f: impl Fn(N) -> N) -> Self {
        self.components_mut().iter_mut().for_each(|own| *own = f(*own));
        self
    }

    /// The same, with another's components where it has what is no number.
    pub(super) fn or(&self, other: &Self) -> Self {
        Self::of_length(self.length, |k| if self.components[k].is_nan() { other.at(k) } else { self.components[k] })
    }

    pub(crate) fn dot(&self, other: &Self) -> N {
        self.components().iter().zip(other.components()).fold(N::zero(), |sum, (a, b)| sum + *a * *b)
    }

    fn of_length(length: usize, f: impl Fn(usize) -> N) -> Self {
        let mut value = Self::zero(length);
        value.components_mut().iter_mut().enumerate().for_each(|(k, own)| *own = f(k));
        value
    }
}

impl<N: Float> FromIterator<N> for Value<N> {
    fn from_iter<I: IntoIterator<Item = N>>(all: I) -> Self {
        let mut value = Self::zero(0);
        for own in all.into_iter().take(MOST) {
            value.components[value.length] = own;
            value.length += 1;
        }
        value
    }
}

fn truth<N: Float>(is: bool) -> N {
    if is { N::one() } else { N::zero() }
}

/// The value of an operation of values, whose types are `types`.
pub(super) fn apply<N: Float>(op: &Op, ty: Type, x: &[Value<N>], types: &[Type]) -> Value<N> {
    let n = ty.length();
    let of = |f: &dyn Fn(usize) -> N| Value::of_length(n, f);
    match op {
        Op::Leaf(_) | Op::Constant(_) => Value::zero(n),
        Op::Negate(_) => x[0].map(|a| -a),
        Op::Not(_) => x[0].map(|a| truth(a == N::zero())),
        Op::Splat(_) => of(&|_| x[0].first()),
        Op::Swizzle(_, pattern) => of(&|k| x[0].components[pattern[k] as usize]),
        Op::Vector(_) | Op::Matrix(_) => x.iter().flat_map(|part| part.components().to_vec()).collect(),
        Op::Column(_, column) => of(&|k| x[0].components[*column as usize * n + k]),
        Op::MatrixVector(..) => of(&|row| sum(x[1].length, |k| x[0].components[k * n + row] * x[1].components[k])),
        Op::VectorMatrix(..) => {
            let rows = x[0].length;
            of(&|column| sum(rows, |k| x[1].components[column * rows + k] * x[0].components[k]))
        }
        Op::MatrixMatrix(..) => {
            let (Type::Matrix(inner, rows), Type::Matrix(..)) = (types[0], types[1]) else { return Value::zero(n) };
            let (inner, rows) = (inner as usize, rows as usize);
            of(&|k| sum(inner, |j| x[0].components[j * rows + k % rows] * x[1].components[k / rows * inner + j]))
        }
        Op::Select(..) => of(&|k| if x[0].at(k) == N::zero() { x[2].at(k) } else { x[1].at(k) }),
        Op::Binary(op, ..) => {
            let is_int = matches!(types[0], Type::Int(_));
            of(&|k| binary(*op, x[0].at(k), x[1].at(k), is_int))
        }
        Op::Call(function, _) if function.is_by_component() => of(&|k| {
            let at = |j: usize| x.get(j).map_or_else(N::zero, |value| value.at(k));
            by_component(*function, [at(0), at(1), at(2)], x.len())
        }),
        Op::Call(function, _) => whole(*function, x, types, n),
    }
}

fn sum<N: Float>(n: usize, term: impl Fn(usize) -> N) -> N {
    (0..n).fold(N::zero(), |sum, k| sum + term(k))
}

fn binary<N: Float>(op: Binary, a: N, b: N, is_int: bool) -> N {
    let zero = N::zero();
    match op {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide if is_int => (a / b).trunc(),
        Binary::Divide => a / b,
        Binary::Remainder => a - b * (a / b).trunc(),
        Binary::Equal => truth(a == b),
        Binary::NotEqual => truth(a != b),
        Binary::Less => truth(a < b),
        Binary::LessEqual => truth(a <= b),
        Binary::Greater => truth(a > b),
        Binary::GreaterEqual => truth(a >= b),
        Binary::And => truth(a != zero && b != zero),
        Binary::Or => truth(a != zero || b != zero),
    }
}

fn by_component<N: Float>(function: Function, [a, b, c]: [N; 3], arguments: usize) -> N {
    use Function as F;
    let (zero, one) = (N::zero(), N::one());
    match function {
        F::Abs => a.abs(),
        // What is left open stays so: nobody guards by max(x, 0) what has no value.
        F::Min | F::Max if a.is_nan() || b.is_nan() => N::nan(),
        F::Min => {
            if b < a {
                b
            } else {
                a
            }
        }
        F::Max => {
            if a < b {
                b
            } else {
                a
            }
        }
        F::Sqrt => a.sqrt(),
        F::Exp => a.exp(),
        F::Exp2 => a.exp2(),
        F::Log => a.ln(),
        F::Log2 => a.log2(),
        // The languages leave the power of a negative number open.
        F::Pow if a < zero => N::nan(),
        F::Pow => a.powf(b),
        F::Sin => a.sin(),
        F::Cos => a.cos(),
        F::Tan => a.tan(),
        F::Acos => a.acos(),
        F::Asin => a.asin(),
        F::Atan if arguments > 1 => a.atan2(b),
        F::Atan => a.atan(),
        F::Floor => a.floor(),
        F::Ceil => a.ceil(),
        F::Round => a.round(),
        F::Trunc | F::ToInt => a.trunc(),
        F::Fract => a - a.floor(),
        F::Sign if a == zero => zero,
        F::Sign => a.signum(),
        F::Mix => a * (one - c) + b * c,
        F::Step => truth(b >= a),
        F::Smoothstep => {
            let t = ((c - a) / (b - a)).max(zero).min(one);
            t * t * (one + one + one - (t + t))
        }
        _ => N::nan(),
    }
}

fn whole<N: Float>(function: Function, x: &[Value<N>], types: &[Type], n: usize) -> Value<N> {
    use Function as F;
    let scalar = |number: N| std::iter::once(number).collect::<Value<N>>();
    match function {
        F::Dot => scalar(x[0].dot(&x[1])),
        F::Length => scalar(x[0].dot(&x[0]).sqrt()),
        F::Normalize => {
            let length = x[0].dot(&x[0]).sqrt();
            x[0].map(|own| own / length)
        }
        F::Cross => {
            let (a, b) = (x[0].components, x[1].components);
            Value::of_length(3, |k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
        }
        F::Reflect => {
            let d = x[0].dot(&x[1]);
            Value::of_length(n, |k| x[0].components[k] - (d + d) * x[1].components[k])
        }
        F::FaceForward => {
            let turns = x[2].dot(&x[1]) >= N::zero();
            x[0].map(|own| if turns { -own } else { own })
        }
        F::Transpose => {
            let Type::Matrix(columns, rows) = types[0] else { return x[0] };
            let (columns, rows) = (columns as usize, rows as usize);
            Value::of_length(n, |k| x[0].components[k % columns * rows + k / columns])
        }
        F::All => scalar(truth(x[0].components().iter().all(|own| *own != N::zero()))),
        F::Any => scalar(truth(x[0].components().iter().any(|own| *own != N::zero()))),
        // No step's form has them.
        _ => Value::of_length(n, |_| N::nan()),
    }
}
