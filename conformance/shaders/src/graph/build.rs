//! Makes nodes, each in one form.

use super::{Binary, Function, Graph, GraphLeaf, Node, NodeId, Op, Operands, Origin, Type, Value};
use smallvec::smallvec;

impl Graph {
    /// The node of an operation, which is in its form already.
    pub(super) fn node(&mut self, op: Op, ty: Type) -> NodeId {
        let key = (op, ty);
        if let Some(&id) = self.known.get(&key) {
            self.occurs(id);
            return id;
        }
        let op = &key.0;
        let operands = op.operands();
        let is_made = !matches!(op, Op::Leaf(_) | Op::Constant(_));
        if is_made && operands.iter().all(|id| matches!(self.op(*id), Op::Constant(_))) {
            let values: Vec<Value<f64>> = operands.iter().filter_map(|id| self.constant_of(*id)).collect();
            let types: Vec<Type> = operands.iter().map(|id| self.ty(*id)).collect();
            let value = super::value::apply(op, ty, &values, &types);
            return self.constant(ty, value.components());
        }
        let id = NodeId(u32::try_from(self.nodes.len()).unwrap_or(u32::MAX));
        self.nodes.push(Node { op: op.clone(), ty, occurrences: vec![] });
        self.known.insert(key, id);
        self.occurs(id);
        id
    }

    /// A value that is not computed. Of one name and type there is one.
    pub fn leaf(&mut self, name: &str, ty: Type, origin: Origin) -> NodeId {
        if let Some(&id) = self.named.get(&(name.to_owned(), ty, origin)) {
            return id;
        }
        let number = u32::try_from(self.leaves.len()).unwrap_or(u32::MAX);
        self.leaves.push(GraphLeaf { name: name.into(), origin });
        let id = self.node(Op::Leaf(number), ty);
        self.named.insert((name.to_owned(), ty, origin), id);
        id
    }

    /// A constant.
    pub fn constant(&mut self, ty: Type, components: &[f64]) -> NodeId {
        // -0 is 0: no form of a step tells them apart.
        self.node(Op::Constant(components.iter().map(|own| (own + 0.0).to_bits()).collect()), ty)
    }

    /// A constant number.
    pub fn number(&mut self, number: f64) -> NodeId {
        self.constant(Type::Float(1), &[number])
    }

    /// The same in all of `n` components.
    pub fn splat(&mut self, a: NodeId, n: u8) -> NodeId {
        let ty = self.ty(a);
        if n == 1 || !ty.is_scalar() { a } else { self.node(Op::Splat(a), ty.of_length(n)) }
    }

    /// The scalar that is in all components, if one is.
    pub(super) fn scalar_of(&mut self, a: NodeId) -> NodeId {
        match (self.op(a), self.ty(a)) {
            (Op::Splat(scalar), _) => *scalar,
            (Op::Constant(_), Type::Float(2..)) => {
                self.number_of(a).map_or(a, |number| self.constant(Type::Float(1), &[number]))
            }
            _ => a,
        }
    }

    /// −a.
    pub fn negate(&mut self, a: NodeId) -> NodeId {
        let ty = self.ty(a);
        match *self.op(a) {
            Op::Negate(inner) => inner,
            Op::Binary(Binary::Subtract, x, y) if ty.is_scalar() => self.binary(Binary::Subtract, y, x),
            Op::Splat(scalar) => {
                let scalar = self.negate(scalar);
                self.splat(scalar, ty.width())
            }
            _ => self.node(Op::Negate(a), ty),
        }
    }

    /// Not a.
    pub fn not(&mut self, a: NodeId) -> NodeId {
        use Binary as B;
        let ty = self.ty(a);
        match *self.op(a) {
            Op::Not(inner) => inner,
            Op::Binary(op, x, y) if self.ty(x).is_scalar() && op.compares() => {
                let op = match op {
                    B::Equal => B::NotEqual,
                    B::NotEqual => B::Equal,
                    B::Less => B::GreaterEqual,
                    B::GreaterEqual => B::Less,
                    B::Greater => B::LessEqual,
                    _ => B::Greater,
                };
                self.node(Op::Binary(op, x, y), ty)
            }
            _ => self.node(Op::Not(a), ty),
        }
    }

    /// An operation of two operands. A scalar beside a vector is in all of its components.
    pub fn binary(&mut self, op: Binary, a: NodeId, b: NodeId) -> NodeId {
        if matches!(self.ty(a), Type::Matrix(..)) || matches!(self.ty(b), Type::Matrix(..)) {
            return self.of_matrices(op, a, b);
        }
        let n = self.ty(a).width().max(self.ty(b).width());
        let (a, b) = if n > 1 { (self.scalar_of(a), self.scalar_of(b)) } else { (a, b) };
        if n > 1 && self.ty(a).is_scalar() && self.ty(b).is_scalar() {
            let scalar = self.binary(op, a, b);
            return self.splat(scalar, n);
        }
        let ty = if op.compares() { Type::Bool(n) } else { self.ty(a).of_length(n) };
        match op {
            Binary::Add => self.sum(a, b, ty),
            Binary::Subtract => self.difference(a, b, ty),
            Binary::Multiply if ty.is_float() => self.product(a, b, ty),
            Binary::Divide if ty.is_float() => self.quotient(a, b, ty),
            Binary::And | Binary::Or => self.logical(op, a, b, ty),
            _ => self.node(Op::Binary(op, a, b), ty),
        }
    }

    fn of_matrices(&mut self, op: Binary, a: NodeId, b: NodeId) -> NodeId {
        let multiplies = op == Binary::Multiply;
        match (self.ty(a), self.ty(b)) {
            (Type::Matrix(columns, rows), Type::Float(n)) if multiplies && n == columns => {
                let (b, is_negative) = self.without_sign(b);
                let product = self.node(Op::MatrixVector(a, b), Type::Float(rows));
                if is_negative { self.negate(product) } else { product }
            }
            (Type::Float(n), Type::Matrix(columns, rows)) if multiplies && n == rows => {
                let (a, is_negative) = self.without_sign(a);
                let product = self.node(Op::VectorMatrix(a, b), Type::Float(columns));
                if is_negative { self.negate(product) } else { product }
            }
            (Type::Matrix(_, rows), Type::Matrix(columns, _)) if multiplies => {
                self.node(Op::MatrixMatrix(a, b), Type::Matrix(columns, rows))
            }
            (ty @ Type::Matrix(..), _) | (_, ty) => self.node(Op::Binary(op, a, b), ty),
        }
    }

    fn sum(&mut self, a: NodeId, b: NodeId, ty: Type) -> NodeId {
        if self.is_number(a, 0.0) {
            return self.splat(b, ty.width());
        }
        if self.is_number(b, 0.0) {
            return self.splat(a, ty.width());
        }
        match (self.without_sign(a), self.without_sign(b)) {
            (_, (b, true)) => self.binary(Binary::Subtract, a, b),
            ((a, true), _) => self.binary(Binary::Subtract, b, a),
            _ => self.node(Op::Binary(Binary::Add, a.min(b), a.max(b)), ty),
        }
    }

    fn difference(&mut self, a: NodeId, b: NodeId, ty: Type) -> NodeId {
        let n = ty.width();
        if self.is_number(b, 0.0) {
            return self.splat(a, n);
        }
        if self.is_number(a, 0.0) {
            let b = self.splat(b, n);
            return self.negate(b);
        }
        if a == b {
            return self.constant(ty, &vec![0.0; ty.length()]);
        }
        match (self.without_sign(a), self.without_sign(b)) {
            (_, (b, true)) => self.binary(Binary::Add, a, b),
            ((a, true), _) => {
                let sum = self.binary(Binary::Add, a, b);
                self.negate(sum)
            }
            // A difference of vectors has one direction, and a sign.
            _ if n > 1 && ty.is_float() && a > b && self.constant_of(a).is_none() && self.constant_of(b).is_none() => {
                let turned = self.node(Op::Binary(Binary::Subtract, b, a), ty);
                self.negate(turned)
            }
            _ => self.node(Op::Binary(Binary::Subtract, a, b), ty),
        }
    }

    fn product(&mut self, a: NodeId, b: NodeId, ty: Type) -> NodeId {
        for (x, y) in [(a, b), (b, a)] {
            if self.is_number(y, 1.0) {
                return self.splat(x, ty.width());
            }
            if self.is_number(y, 0.0) {
                return self.constant(ty, &vec![0.0; ty.length()]);
            }
            if self.is_number(y, -1.0) {
                let x = self.splat(x, ty.width());
                return self.negate(x);
            }
            if let (inner, true) = self.without_sign(x) {
                let product = self.binary(Binary::Multiply, inner, y);
                return self.negate(product);
            }
            // A sign that a constant has is the product's.
            if let Some(number) = self.number_of(y).filter(|own| *own < 0.0) {
                let factor = self.constant(self.ty(y), &vec![-number; self.ty(y).length()]);
                let product = self.binary(Binary::Multiply, x, factor);
                return self.negate(product);
            }
            // v · (1/|v|)
            if let Op::Binary(Binary::Divide, one, length) = *self.op(y)
                && self.is_number(one, 1.0)
                && self.is_length_of(length, x)
            {
                return self.call(Function::Normalize, smallvec![x]);
            }
        }
        self.node(Op::Binary(Binary::Multiply, a.min(b), a.max(b)), ty)
    }

    fn is_length_of(&self, length: NodeId, vector: NodeId) -> bool {
        matches!(self.op(length), Op::Call(Function::Length, of) if of[0] == vector)
    }

    fn quotient(&mut self, a: NodeId, b: NodeId, ty: Type) -> NodeId {
        if self.is_number(b, 1.0) {
            return self.splat(a, ty.width());
        }
        if self.is_number(a, 0.0) {
            return self.constant(ty, &vec![0.0; ty.length()]);
        }
        match (self.without_sign(a), self.without_sign(b)) {
            ((inner, true), (divisor, is_negative)) => {
                let quotient = self.binary(Binary::Divide, inner, divisor);
                return if is_negative { quotient } else { self.negate(quotient) };
            }
            (_, (divisor, true)) => {
                let quotient = self.binary(Binary::Divide, a, divisor);
                return self.negate(quotient);
            }
            _ => {}
        }
        if self.is_length_of(b, a) {
            return self.call(Function::Normalize, smallvec![a]);
        }
        // What divides by a power of two multiplies exactly.
        if let Some(number) = self.number_of(b)
            && number > 0.0
            && number.log2().fract() == 0.0
        {
            let factor = self.number(1.0 / number);
            return self.binary(Binary::Multiply, a, factor);
        }
        self.node(Op::Binary(Binary::Divide, a, b), ty)
    }

    fn logical(&mut self, op: Binary, a: NodeId, b: NodeId, ty: Type) -> NodeId {
        let (neutral, decides) = if op == Binary::And { (1.0, 0.0) } else { (0.0, 1.0) };
        for (x, y) in [(a, b), (b, a)] {
            if self.is_number(y, neutral) || x == y {
                return x;
            }
            if self.is_number(y, decides) {
                return y;
            }
        }
        self.node(Op::Binary(op, a, b), ty)
    }

    /// A built-in function of its arguments.
    pub(crate) fn call(&mut self, function: Function, mut x: Operands) -> NodeId {
        if !function.is_by_component() {
            return self.whole(function, x);
        }
        let n = x.iter().map(|own| self.ty(*own).width()).max().unwrap_or(1);
        if n > 1 {
            x = x.into_iter().map(|own| self.scalar_of(own)).collect();
            if x.iter().all(|own| self.ty(*own).is_scalar()) {
                let scalar = self.call(function, x);
                return self.splat(scalar, n);
            }
        }
        let ty = match function {
            Function::ToInt => Type::Int(n),
            _ if x.iter().any(|own| self.ty(*own).is_float()) => Type::Float(n),
            _ => self.ty(x[0]).of_length(n),
        };
        match function {
            Function::Sqrt => {
                // √(v·v) is |v|.
                if let Op::Binary(Binary::Multiply, a, b) = *self.op(x[0])
                    && a == b
                    && matches!(self.op(a), Op::Call(Function::Length, _))
                {
                    return a;
                }
            }
            Function::Pow if self.is_number(x[1], 1.0) => return self.splat(x[0], n),
            Function::Pow if self.is_number(x[1], 2.0) => return self.binary(Binary::Multiply, x[0], x[0]),
            Function::Min | Function::Max if x[0] == x[1] => return x[0],
            Function::Min | Function::Max => x.sort_unstable(),
            Function::Abs => x[0] = self.without_sign(x[0]).0,
            Function::Mix if matches!(self.ty(x[2]), Type::Bool(_)) => return self.select(x[2], x[1], x[0]),
            _ => {}
        }
        self.node(Op::Call(function, x), ty)
    }

    /// max(a, low), then min(…, high).
    pub(crate) fn clamp(&mut self, a: NodeId, low: NodeId, high: NodeId) -> NodeId {
        let held = self.call(Function::Max, smallvec![a, low]);
        self.call(Function::Min, smallvec![held, high])
    }

    fn whole(&mut self, function: Function, mut x: Operands) -> NodeId {
        use Function as F;
        let ty = self.ty(x[0]);
        let (bare, is_negative) = self.without_sign(x[0]);
        match function {
            F::Normalize | F::Reflect if is_negative => {
                x[0] = bare;
                let made = self.whole(function, x);
                self.negate(made)
            }
            F::Normalize if matches!(self.op(bare), Op::Call(F::Normalize, _)) => bare,
            F::Normalize if ty.is_scalar() => self.call(F::Sign, x),
            F::Reflect => {
                x[1] = self.without_sign(x[1]).0;
                self.node(Op::Call(function, x), ty)
            }
            F::Length if ty.is_scalar() => self.call(F::Abs, x),
            F::Length => self.node(Op::Call(function, smallvec![bare]), Type::Float(1)),
            F::Dot if ty.is_scalar() => self.binary(Binary::Multiply, x[0], x[1]),
            F::Dot => self.dot(x[0], x[1]),
            F::All | F::Any if ty.is_scalar() => x[0],
            F::All | F::Any => self.node(Op::Call(function, x), Type::Bool(1)),
            F::Transpose => match (self.op(x[0]).clone(), ty) {
                (Op::Call(F::Transpose, inner), _) => inner[0],
                (_, Type::Matrix(columns, rows)) => self.node(Op::Call(function, x), Type::Matrix(rows, columns)),
                _ => x[0],
            },
            F::Determinant => self.node(Op::Call(function, x), Type::Float(1)),
            _ => self.node(Op::Call(function, x), ty),
        }
    }

    fn dot(&mut self, a: NodeId, b: NodeId) -> NodeId {
        let ((a, a_negative), (b, b_negative)) = (self.without_sign(a), self.without_sign(b));
        let product = if a == b {
            let length = self.call(Function::Length, smallvec![a]);
            self.binary(Binary::Multiply, length, length)
        } else {
            self.dot_of_parts(a, b)
                .or_else(|| self.dot_of_parts(b, a))
                .unwrap_or_else(|| self.node(Op::Call(Function::Dot, smallvec![a.min(b), a.max(b)]), Type::Float(1)))
        };
        if a_negative == b_negative { product } else { self.negate(product) }
    }

    /// The dot product with a vector of scalars is a sum.
    fn dot_of_parts(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let Op::Vector(parts) = self.op(a).clone() else { return None };
        if !parts.iter().all(|part| self.ty(*part).is_scalar()) {
            return None;
        }
        let mut sum = self.number(0.0);
        for (k, part) in (0..).zip(parts) {
            let own = self.swizzle(b, &[k]);
            let term = self.binary(Binary::Multiply, part, own);
            sum = self.binary(Binary::Add, sum, term);
        }
        Some(sum)
    }

    /// `yes` where a condition holds, else `no`.
    pub fn select(&mut self, condition: NodeId, yes: NodeId, no: NodeId) -> NodeId {
        if yes == no {
            return yes;
        }
        if let (Some(number), true) = (self.number_of(condition), self.ty(condition).is_scalar()) {
            return if number == 0.0 { no } else { yes };
        }
        match (self.op(condition), self.op(yes), self.op(no)) {
            (&Op::Not(turned), ..) => return self.select(turned, no, yes),
            // What is chosen by the same condition again is known.
            (_, &Op::Select(inner, first, _), _) if inner == condition => return self.select(condition, first, no),
            (_, _, &Op::Select(inner, _, second)) if inner == condition => return self.select(condition, yes, second),
            (_, Op::Vector(p), Op::Vector(q))
                if p.len() == q.len() && p.iter().zip(q).all(|(a, b)| self.ty(*a) == self.ty(*b)) =>
            {
                let pairs: Vec<(NodeId, NodeId)> = p.iter().copied().zip(q.iter().copied()).collect();
                let parts: Vec<NodeId> = pairs.into_iter().map(|(a, b)| self.select(condition, a, b)).collect();
                return self.vector(&parts);
            }
            (_, &Op::Splat(a), &Op::Splat(b)) => {
                let n = self.ty(yes).width();
                let scalar = self.select(condition, a, b);
                return self.splat(scalar, n);
            }
            _ => {}
        }
        let ty = match (self.ty(yes), self.ty(no)) {
            (ty @ Type::Matrix(..), _) => ty,
            (ty, other) => ty.of_length(ty.width().max(other.width())),
        };
        self.node(Op::Select(condition, yes, no), ty)
    }
}
