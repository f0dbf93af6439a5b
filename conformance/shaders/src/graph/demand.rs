//! Which components of each value a result is made of.

use super::{Graph, NodeId, Op, Type};
use std::collections::HashMap;

/// All components of any type.
const ALL: u8 = 0b1111;

impl Graph {
    /// For each value that a result is made of, the components that enter it, as bits. A value whose components are all left out has none.
    pub(crate) fn demanded(&self, root: NodeId) -> HashMap<NodeId, u8> {
        let mut found = HashMap::from([(root, ALL)]);
        // Operands come before what is made of them.
        for id in self.all_of(root).into_iter().rev() {
            let own = found.get(&id).copied().unwrap_or(0);
            if own == 0 {
                continue;
            }
            let op = self.op(id);
            let mut first = 0;
            for operand in op.operands() {
                let length = self.ty(operand).length();
                let of = match op {
                    Op::Swizzle(_, pattern) => {
                        let taken = pattern.iter().enumerate().filter(|(k, _)| own & (1 << k) != 0);
                        taken.fold(0, |all, (_, component)| all | 1 << component)
                    }
                    Op::Vector(_) => {
                        let part = (own >> first) & ((1 << length) - 1);
                        first += length;
                        part
                    }
                    Op::Negate(_) | Op::Not(_) | Op::Binary(..) | Op::Select(..) => own,
                    Op::Call(function, _) if function.is_by_component() => own,
                    _ => ALL,
                };
                // One number stands for all components.
                let is_by_itself =
                    length == 1 && !matches!(op, Op::Vector(_)) || matches!(self.ty(operand), Type::Matrix(..));
                let of = if is_by_itself { ALL } else { of };
                *found.entry(operand).or_default() |= of;
            }
        }
        found
    }
}
