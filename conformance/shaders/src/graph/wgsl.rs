//! What is computed between a value and a cut, as a function in WGSL.

use super::text::{COMPONENTS, sign};
use super::{Binary, Function, Graph, NodeId, Op, Type, Value};
use std::collections::HashMap;
use std::fmt::Write as _;

/// A number as WGSL has it; none of what is no number.
fn number(own: f64) -> Option<String> {
    #[expect(clippy::cast_possible_truncation, reason = "shaders compute in f32")]
    let own = own as f32;
    own.is_finite().then(|| format!("{own:?}f"))
}

/// A type's name; none of one that WGSL has not.
fn type_name(ty: Type) -> Option<String> {
    Some(match ty {
        Type::Float(1) => "f32".into(),
        Type::Int(1) => "i32".into(),
        Type::Bool(1) => "bool".into(),
        Type::Float(n @ 2..=4) => format!("vec{n}f"),
        Type::Int(n @ 2..=4) => format!("vec{n}i"),
        Type::Bool(n @ 2..=4) => format!("vec{n}<bool>"),
        Type::Matrix(columns @ 2..=4, rows @ 2..=4) => format!("mat{columns}x{rows}f"),
        _ => return None,
    })
}

/// A function's name in WGSL, given how many arguments it has; none where WGSL has no such function.
fn function_name(function: Function, arguments: usize) -> Option<String> {
    Some(match function {
        Function::Atan if arguments > 1 => "atan2".into(),
        Function::FaceForward => "faceForward".into(),
        Function::ToInt | Function::Inverse => return None,
        other => format!("{other:?}").to_lowercase(),
    })
}

/// Values that have names.
struct Names<'a> {
    graph: &'a Graph,
    of: HashMap<NodeId, String>,
}

impl Names<'_> {
    fn of(&self, id: NodeId) -> Option<&str> {
        self.of.get(&id).map(String::as_str)
    }

    /// A value with as many components as `ty` has, where it is a scalar.
    fn spread(&self, id: NodeId, ty: Type) -> Option<String> {
        let own = self.graph.ty(id);
        let name = self.of(id)?;
        if own.length() == ty.length() || !own.is_scalar() {
            return Some(name.to_owned());
        }
        Some(format!("{}({name})", type_name(own.of_length(ty.width()))?))
    }

    fn list(&self, ids: &[NodeId]) -> Option<String> {
        Some(ids.iter().map(|own| self.of(*own)).collect::<Option<Vec<_>>>()?.join(", "))
    }

    fn constant(value: &Value<f64>, ty: Type) -> Option<String> {
        let part = |own: &f64| match ty {
            Type::Float(_) | Type::Matrix(..) => number(*own),
            Type::Int(_) => Some(format!("{own:.0}")),
            Type::Bool(_) => Some((*own != 0.0).to_string()),
        };
        let parts = value.components().iter().map(part).collect::<Option<Vec<_>>>()?;
        if parts.len() == 1 {
            parts.into_iter().next()
        } else {
            Some(format!("{}({})", type_name(ty)?, parts.join(", ")))
        }
    }

    fn binary(&self, op: Binary, a: NodeId, b: NodeId) -> Option<String> {
        let (left, right) = (self.graph.ty(a), self.graph.ty(b));
        let is_matrix = matches!(left, Type::Matrix(..)) || matches!(right, Type::Matrix(..));
        let widest = if left.length() >= right.length() { left } else { right };
        let (x, y) = if is_matrix {
            (self.of(a)?.to_owned(), self.of(b)?.to_owned())
        } else {
            (self.spread(a, widest)?, self.spread(b, widest)?)
        };
        let by_component = widest.width() > 1;
        let sign = match op {
            Binary::And if by_component => "&",
            Binary::Or if by_component => "|",
            op => sign(op),
        };
        Some(format!("{x} {sign} {y}"))
    }

    /// The expression of a value, made of values that have names.
    fn expression(&self, id: NodeId) -> Option<String> {
        let ty = self.graph.ty(id);
        Some(match self.graph.op(id) {
            Op::Leaf(_) => return None,
            Op::Constant(_) => Self::constant(&self.graph.constant_of(id)?, ty)?,
            Op::Negate(x) => format!("-{}", self.of(*x)?),
            Op::Not(x) => format!("!{}", self.of(*x)?),
            Op::Binary(op, a, b) => self.binary(*op, *a, *b)?,
            Op::MatrixVector(a, b) | Op::VectorMatrix(a, b) | Op::MatrixMatrix(a, b) => {
                format!("{} * {}", self.of(*a)?, self.of(*b)?)
            }
            Op::Call(Function::ToInt, x) => format!("{}({})", type_name(ty)?, self.list(x)?),
            Op::Call(Function::Normalize, x) if self.graph.ty(x[0]).is_scalar() => return None,
            Op::Call(function, x) => {
                let name = function_name(*function, x.len())?;
                let arguments = if function.is_by_component() {
                    x.iter().map(|own| self.spread(*own, ty)).collect::<Option<Vec<_>>>()?.join(", ")
                } else {
                    self.list(x)?
                };
                format!("{name}({arguments})")
            }
            Op::Select(condition, yes, no) => {
                format!("select({}, {}, {})", self.spread(*no, ty)?, self.spread(*yes, ty)?, self.of(*condition)?)
            }
            Op::Swizzle(x, pattern) => {
                let pattern: String = pattern.iter().map(|k| COMPONENTS[usize::from(*k) % 4]).collect();
                format!("{}.{pattern}", self.of(*x)?)
            }
            Op::Vector(all) | Op::Matrix(all) => format!("{}({})", type_name(ty)?, self.list(all)?),
            Op::Splat(x) => format!("{}({})", type_name(ty)?, self.of(*x)?),
            Op::Column(x, k) => format!("{}[{k}]", self.of(*x)?),
        })
    }
}

impl Graph {
    /// A value as a function `shader_step` of a cut, whose values have names; none where it needs more than `most` operations, a leaf that is not
    /// of the cut, or what WGSL has not.
    pub(crate) fn wgsl(&self, root: NodeId, cut: &[(NodeId, String)], most: usize) -> Option<String> {
        let ids: Vec<NodeId> = cut.iter().map(|own| own.0).collect();
        let cone = self.cone(root, &ids, most)?;
        let parameters = cut.iter().map(|(id, name)| Some(format!("{name}: {}", type_name(self.ty(*id))?)));
        let parameters = parameters.collect::<Option<Vec<_>>>()?.join(", ");
        let mut text = format!("fn shader_step({parameters}) -> {} {{\n", type_name(self.ty(root))?);
        let mut names = Names { graph: self, of: cut.iter().cloned().collect() };
        for (k, id) in cone.iter().enumerate() {
            let expression = names.expression(*id)?;
            if *id == root {
                let _ = writeln!(text, "    return {expression};\n}}");
                return Some(text);
            }
            let name = format!("t{k}");
            let _ = writeln!(text, "    let {name} = {expression};");
            names.of.insert(*id, name);
        }
        None
    }
}
