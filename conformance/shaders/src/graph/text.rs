//! A value as a reader of shaders would write it.

use super::{Binary, Function, Graph, NodeId, Op};

pub(super) const COMPONENTS: [char; 4] = ['x', 'y', 'z', 'w'];

impl Graph {
    /// A value as text, with what is more than `depth` operations away left out.
    #[must_use]
    pub fn text(&self, id: NodeId, depth: u32) -> String {
        let is_short =
            matches!(self.op(id), Op::Leaf(_) | Op::Constant(_) | Op::Swizzle(..) | Op::Negate(_) | Op::Splat(_));
        if depth == 0 && !is_short {
            return "…".into();
        }
        let next = depth.saturating_sub(1);
        let own = |id: &NodeId| self.text(*id, next);
        let list = |all: &[NodeId]| all.iter().map(own).collect::<Vec<_>>().join(", ");
        match self.op(id) {
            Op::Leaf(k) => self.leaves[*k as usize].name.clone(),
            Op::Constant(bits) if bits.len() == 1 => number(f64::from_bits(bits[0])),
            Op::Constant(bits) => {
                format!("({})", bits.iter().map(|own| number(f64::from_bits(*own))).collect::<Vec<_>>().join(", "))
            }
            Op::Negate(x) => format!("-{}", own(x)),
            Op::Not(x) => format!("!{}", own(x)),
            Op::Binary(op, x, y) => format!("({} {} {})", own(x), sign(*op), own(y)),
            Op::MatrixVector(x, y) | Op::VectorMatrix(x, y) | Op::MatrixMatrix(x, y) => {
                format!("({} * {})", own(x), own(y))
            }
            Op::Call(function, all) => format!("{}({})", name(*function), list(all)),
            Op::Select(condition, x, y) => format!("({} ? {} : {})", own(condition), own(x), own(y)),
            Op::Swizzle(x, pattern) => {
                let pattern: String = pattern.iter().map(|k| COMPONENTS[usize::from(*k) % 4]).collect();
                format!("{}.{pattern}", self.text(*x, next))
            }
            Op::Vector(all) => format!("vec{}({})", self.ty(id).length(), list(all)),
            Op::Splat(x) => self.text(*x, depth),
            Op::Matrix(all) => format!("mat{}({})", all.len(), list(all)),
            Op::Column(x, k) => format!("{}[{k}]", own(x)),
        }
    }
}

/// A number with six digits after its point at most.
fn number(own: f64) -> String {
    let text = format!("{own:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

pub(super) const fn sign(op: Binary) -> &'static str {
    match op {
        Binary::Add => "+",
        Binary::Subtract => "-",
        Binary::Multiply => "*",
        Binary::Divide => "/",
        Binary::Remainder => "%",
        Binary::Equal => "==",
        Binary::NotEqual => "!=",
        Binary::Less => "<",
        Binary::LessEqual => "<=",
        Binary::Greater => ">",
        Binary::GreaterEqual => ">=",
        Binary::And => "&&",
        Binary::Or => "||",
    }
}

fn name(function: Function) -> String {
    match function {
        Function::ToInt => "int".into(),
        other => format!("{other:?}").to_lowercase(),
    }
}
