//! Makes vectors of their components, and takes components of vectors.

use super::{Function, Graph, NodeId, Op, Operands, Pattern, Type};
use smallvec::{SmallVec, smallvec};

/// How deep components are compared to make a vector of them again.
const MOST_DEPTH: u32 = 6;

impl Graph {
    /// Components of a vector, in an order.
    pub fn swizzle(&mut self, a: NodeId, pattern: &[u8]) -> NodeId {
        let ty = self.ty(a);
        if pattern.len() == ty.length() && pattern.iter().enumerate().all(|(k, own)| k == usize::from(*own)) {
            return a;
        }
        let n = u8::try_from(pattern.len()).unwrap_or(4);
        match self.op(a).clone() {
            Op::Swizzle(inner, of) => {
                let own: Pattern = pattern.iter().map(|k| of[usize::from(*k)]).collect();
                self.swizzle(inner, &own)
            }
            Op::Splat(scalar) => self.splat(scalar, n),
            Op::Negate(inner) => {
                let own = self.swizzle(inner, pattern);
                self.negate(own)
            }
            Op::Vector(parts) => self.components_of(&parts, pattern),
            Op::Binary(op, x, y) if ty.is_float() && n > 1 => {
                let (x, y) = (self.components(x, pattern), self.components(y, pattern));
                self.binary(op, x, y)
            }
            Op::Call(function, arguments) if ty.is_float() && n > 1 && function.is_by_component() => {
                let arguments = arguments.into_iter().map(|own| self.components(own, pattern)).collect();
                self.call(function, arguments)
            }
            Op::Select(condition, x, y) if n > 1 && self.ty(condition).is_scalar() => {
                let (x, y) = (self.components(x, pattern), self.components(y, pattern));
                self.select(condition, x, y)
            }
            _ => self.node(Op::Swizzle(a, pattern.into()), ty.of_length(n)),
        }
    }

    /// The same of an operand, which may be a scalar.
    fn components(&mut self, a: NodeId, pattern: &[u8]) -> NodeId {
        if self.ty(a).is_scalar() { a } else { self.swizzle(a, pattern) }
    }

    fn components_of(&mut self, parts: &[NodeId], pattern: &[u8]) -> NodeId {
        let lanes: Vec<(NodeId, u8)> =
            parts.iter().flat_map(|part| (0..self.ty(*part).width()).map(|k| (*part, k))).collect();
        let mut found: Vec<NodeId> = vec![];
        let mut rest = pattern;
        while let Some(first) = rest.first() {
            let part = lanes[usize::from(*first)].0;
            let width = usize::from(self.ty(part).width());
            let run = rest.iter().take(width).take_while(|k| lanes[usize::from(**k)].0 == part).count();
            let own: Pattern = rest[..run].iter().map(|k| lanes[usize::from(*k)].1).collect();
            found.push(self.components(part, &own));
            rest = &rest[run..];
        }
        self.vector(&found)
    }

    /// A vector of scalars and vectors one after the other.
    pub fn vector(&mut self, parts: &[NodeId]) -> NodeId {
        let mut flat: Operands = smallvec![];
        for part in parts {
            match self.op(*part).clone() {
                Op::Vector(inner) => flat.extend(inner),
                Op::Splat(scalar) => flat.extend(std::iter::repeat_n(scalar, self.ty(*part).length())),
                Op::Constant(bits) if bits.len() > 1 => {
                    let ty = self.ty(*part).of_length(1);
                    flat.extend(bits.iter().map(|own| self.constant(ty, &[f64::from_bits(*own)])));
                }
                _ => flat.push(*part),
            }
        }
        let total: usize = flat.iter().map(|part| self.ty(*part).length()).sum();
        let ty = self.ty(flat[0]).of_length(u8::try_from(total).unwrap_or(4));
        if flat.len() > 1 && self.ty(flat[0]).is_scalar() && flat.iter().all(|part| *part == flat[0]) {
            return self.splat(flat[0], ty.width());
        }
        let joined = self.neighbours_joined(&flat);
        if joined.len() == 1 {
            return joined[0];
        }
        // Scalars that are computed alike are one vector.
        for take in [joined.len(), 3] {
            let alike =
                ty.is_float() && take <= joined.len() && joined[..take].iter().all(|id| self.ty(*id).is_scalar());
            if let Some(vector) = alike.then(|| self.regrouped(&joined[..take], 0)).flatten()
                && self.ty(vector).length() == take
            {
                let parts: Operands = std::iter::once(vector).chain(joined[take..].iter().copied()).collect();
                return if parts.len() == 1 { vector } else { self.node(Op::Vector(parts), ty) };
            }
        }
        self.node(Op::Vector(joined), ty)
    }

    /// Components of one vector that follow each other are one part.
    fn neighbours_joined(&mut self, flat: &[NodeId]) -> Operands {
        let mut found: Operands = smallvec![];
        let mut rest = flat;
        while let Some(first) = rest.first() {
            let Op::Swizzle(of, mut pattern) = self.op(*first).clone() else {
                found.push(*first);
                rest = &rest[1..];
                continue;
            };
            let mut run = 1;
            while let Some(Op::Swizzle(other, more)) = rest.get(run).map(|id| self.op(*id)) {
                if *other != of || pattern.len() + more.len() > 4 {
                    break;
                }
                pattern.extend(more.iter().copied());
                run += 1;
            }
            found.push(if run == 1 { *first } else { self.swizzle(of, &pattern) });
            rest = &rest[run..];
        }
        found
    }

    /// The vector whose components are these scalars, if they are computed alike.
    #[expect(clippy::too_many_lines, reason = "one arm for each kind of operation")]
    fn regrouped(&mut self, parts: &[NodeId], depth: u32) -> Option<NodeId> {
        if parts.iter().all(|part| *part == parts[0]) {
            return Some(parts[0]);
        }
        if depth > MOST_DEPTH {
            return None;
        }
        match self.op(parts[0]).clone() {
            Op::Swizzle(of, _) => {
                let mut pattern = Pattern::new();
                for part in parts {
                    let Op::Swizzle(other, own) = self.op(*part) else { return None };
                    if *other != of {
                        return None;
                    }
                    pattern.extend(own.iter().copied());
                }
                Some(self.swizzle(of, &pattern))
            }
            Op::Constant(_) => {
                let numbers: Option<Vec<f64>> = parts.iter().map(|part| self.number_of(*part)).collect();
                Some(self.constant(Type::Float(u8::try_from(parts.len()).ok()?), &numbers?))
            }
            Op::Negate(_) => {
                let inner: SmallVec<[NodeId; 4]> = parts.iter().map(|part| self.without_sign(*part).0).collect();
                let is_each = parts.iter().all(|part| self.without_sign(*part).1);
                let own = is_each.then(|| self.regrouped(&inner, depth + 1)).flatten()?;
                Some(self.negate(own))
            }
            Op::Binary(op, ..) if !op.compares() => {
                let both = |id: &NodeId| match *self.op(*id) {
                    Op::Binary(own, x, y) if own == op => Some((x, y)),
                    _ => None,
                };
                let pairs: Vec<(NodeId, NodeId)> = parts.iter().map(both).collect::<Option<_>>()?;
                let columns = self.columns(&pairs, depth)?;
                Some(self.binary(op, columns.0, columns.1))
            }
            Op::Call(function, own) if function.is_by_component() && function != Function::ToInt => {
                let mut arguments = Operands::new();
                for k in 0..own.len() {
                    let column = |id: &NodeId| match self.op(*id) {
                        Op::Call(other, all) if *other == function => all.get(k).copied(),
                        _ => None,
                    };
                    let column: Vec<NodeId> = parts.iter().map(column).collect::<Option<_>>()?;
                    arguments.push(self.regrouped(&column, depth + 1)?);
                }
                Some(self.call(function, arguments))
            }
            Op::Select(condition, ..) => {
                let both = |id: &NodeId| match *self.op(*id) {
                    Op::Select(other, x, y) if other == condition => Some((x, y)),
                    _ => None,
                };
                let pairs: Vec<(NodeId, NodeId)> = parts.iter().map(both).collect::<Option<_>>()?;
                let (x, y) = self.columns(&pairs, depth)?;
                let n = u8::try_from(parts.len()).ok()?;
                let (x, y) = (self.splat(x, n), self.splat(y, n));
                Some(self.select(condition, x, y))
            }
            _ => None,
        }
    }

    /// The vectors of the first and of the second operands. Operands stand in the order of their making: what all share may be in either place.
    fn columns(&mut self, pairs: &[(NodeId, NodeId)], depth: u32) -> Option<(NodeId, NodeId)> {
        let (left, right): (Vec<NodeId>, Vec<NodeId>) = pairs.iter().copied().unzip();
        if let (Some(x), Some(y)) = (self.regrouped(&left, depth + 1), self.regrouped(&right, depth + 1)) {
            return Some((x, y));
        }
        let shared = [left[0], right[0]].into_iter().find(|own| pairs.iter().all(|(x, y)| x == own || y == own))?;
        let others: Vec<NodeId> = pairs.iter().map(|(x, y)| if *x == shared { *y } else { *x }).collect();
        Some((shared, self.regrouped(&others, depth + 1)?))
    }

    /// A matrix of its columns.
    pub(crate) fn matrix(&mut self, columns: Operands) -> NodeId {
        let ty = Type::Matrix(u8::try_from(columns.len()).unwrap_or(4), self.ty(columns[0]).width());
        if let Op::Column(of, 0) = *self.op(columns[0])
            && self.ty(of) == ty
            && (0..).zip(&columns).all(|(k, column)| *self.op(*column) == Op::Column(of, k))
        {
            return of;
        }
        self.node(Op::Matrix(columns), ty)
    }

    /// A column of a matrix.
    pub(crate) fn column(&mut self, of: NodeId, k: u8) -> NodeId {
        let Type::Matrix(_, rows) = self.ty(of) else { return of };
        match self.op(of) {
            Op::Matrix(columns) => columns.get(usize::from(k)).copied().unwrap_or(columns[0]),
            _ => self.node(Op::Column(of, k), Type::Float(rows)),
        }
    }
}
