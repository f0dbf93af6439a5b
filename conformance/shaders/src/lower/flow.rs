//! Statements: branches become choices, loops are taken once.

use super::memory::{State, Variable};
use super::{Frame, Lowering, MOST_CALLS, Symbol};
use crate::graph::{Binary, NodeId};
use naga::{Function, Handle, Statement, SwitchCase, SwitchValue};
use std::collections::HashMap;

/// How a way through statements ends.
#[derive(Clone)]
pub(super) enum End {
    Normal,
    Break,
    Continue,
    Return(Option<Symbol>),
    Discard,
}

/// Ways through statements.
pub(super) enum Flow {
    End(End, State),
    Branch(NodeId, Box<Flow>, Box<Flow>),
}

impl<'a> Lowering<'a> {
    #[expect(clippy::too_many_lines, reason = "one arm for each kind of statement")]
    pub(super) fn block(&mut self, frame: &mut Frame<'a>, mut state: State, body: &'a [Statement]) -> Flow {
        for (k, statement) in body.iter().enumerate() {
            self.statements += 1;
            if self.is_full() {
                break;
            }
            let rest = &body[k + 1..];
            match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        frame.values.remove(&handle);
                        self.expression(frame, &state, handle);
                    }
                }
                Statement::Block(inner) => {
                    let flow = self.block(frame, state, inner);
                    return self.go_on(flow, frame, rest);
                }
                Statement::If { condition, accept, reject } => {
                    let Symbol::Value(condition) = self.expression(frame, &state, *condition) else { continue };
                    let flow = match self.graph.number_of(condition) {
                        Some(number) => self.block(frame, state, if number == 0.0 { reject } else { accept }),
                        None => {
                            let yes = self.under(condition, true, |own| own.block(frame, state.clone(), accept));
                            let no = self.under(condition, false, |own| own.block(frame, state, reject));
                            Flow::Branch(condition, Box::new(yes), Box::new(no))
                        }
                    };
                    return self.go_on(flow, frame, rest);
                }
                Statement::Switch { selector, cases } => {
                    let Symbol::Value(selector) = self.expression(frame, &state, *selector) else { continue };
                    let flow = self.switch(frame, state, selector, cases, None);
                    let flow = flow.ends(&|end| if matches!(end, End::Break) { End::Normal } else { end });
                    return self.go_on(flow, frame, rest);
                }
                Statement::Loop { body: inner, continuing, .. } => {
                    self.has_loops = true;
                    self.loops += 1;
                    let flow = self.block(frame, state, inner).without_guards();
                    let flow = flow.ends(&|end| if matches!(end, End::Continue) { End::Normal } else { end });
                    let flow = self.go_on(flow, frame, continuing);
                    let flow = self.go_on(flow, frame, &inner[..head(inner)]);
                    self.loops -= 1;
                    let flow = flow.ends(&|end| if matches!(end, End::Break) { End::Normal } else { end });
                    return self.go_on(flow, frame, rest);
                }
                Statement::Break => return Flow::End(End::Break, state),
                Statement::Continue => return Flow::End(End::Continue, state),
                Statement::Return { value } => {
                    let value = value.map(|value| self.expression(frame, &state, value));
                    return Flow::End(End::Return(value), state);
                }
                Statement::Kill => return Flow::End(End::Discard, state),
                Statement::Store { pointer, value } => {
                    let value = self.expression(frame, &state, *value);
                    if let Symbol::Pointer(pointer) = self.expression(frame, &state, *pointer) {
                        self.store(&mut state, &pointer, value, Some(frame.function));
                    }
                }
                Statement::Call { function, arguments, result } => {
                    let arguments = arguments.iter().map(|own| self.expression(frame, &state, *own)).collect();
                    let (value, after) = self.called(*function, arguments, state);
                    state = after;
                    if let Some(result) = result {
                        frame.values.insert(*result, value);
                    }
                }
                _ => {}
            }
        }
        Flow::End(End::Normal, state)
    }

    /// What is read under a condition.
    fn under<T>(&mut self, condition: NodeId, holds: bool, read: impl FnOnce(&mut Self) -> T) -> T {
        self.graph.conditions.push((condition, holds));
        let found = read(self);
        self.graph.conditions.pop();
        found
    }

    /// What follows, on each way that comes to it.
    fn go_on(&mut self, flow: Flow, frame: &mut Frame<'a>, rest: &'a [Statement]) -> Flow {
        let flow = self.settled(flow, frame);
        if rest.is_empty() { flow } else { self.then(flow, frame, rest) }
    }

    fn then(&mut self, flow: Flow, frame: &mut Frame<'a>, rest: &'a [Statement]) -> Flow {
        match flow {
            Flow::End(End::Normal, state) => self.block(frame, state, rest),
            Flow::End(..) => flow,
            Flow::Branch(condition, yes, no) => {
                let yes = self.under(condition, true, |own| own.then(*yes, frame, rest));
                let no = self.under(condition, false, |own| own.then(*no, frame, rest));
                Flow::Branch(condition, Box::new(yes), Box::new(no))
            }
        }
    }

    /// Joins ways that both go on.
    fn settled(&mut self, flow: Flow, frame: &Frame<'a>) -> Flow {
        let Flow::Branch(condition, yes, no) = flow else { return flow };
        match (self.settled(*yes, frame), self.settled(*no, frame)) {
            (Flow::End(End::Normal, a), Flow::End(End::Normal, b)) => {
                Flow::End(End::Normal, self.merged(condition, a, b, frame.function, frame.number))
            }
            (yes, no) => Flow::Branch(condition, Box::new(yes), Box::new(no)),
        }
    }

    fn switch(
        &mut self,
        frame: &mut Frame<'a>,
        state: State,
        selector: NodeId,
        cases: &'a [SwitchCase],
        before: Option<NodeId>,
    ) -> Flow {
        let Some((first, rest)) = cases.split_first() else { return Flow::End(End::Normal, state) };
        let number = match first.value {
            SwitchValue::I32(own) => Some(f64::from(own)),
            SwitchValue::U32(own) => Some(f64::from(own)),
            SwitchValue::Default => None,
        };
        let own = number.map(|number| {
            let number = self.graph.constant(self.graph.ty(selector), &[number]);
            self.graph.binary(Binary::Equal, selector, number)
        });
        let condition = match (own, before) {
            (Some(own), Some(before)) => Some(self.graph.binary(Binary::Or, own, before)),
            (own, _) => own,
        };
        if first.fall_through && first.body.is_empty() {
            return self.switch(frame, state, selector, rest, condition.or(before));
        }
        match condition {
            Some(condition) => {
                let yes = self.under(condition, true, |own| own.block(frame, state.clone(), &first.body));
                let no = self.under(condition, false, |own| own.switch(frame, state, selector, rest, None));
                Flow::Branch(condition, Box::new(yes), Box::new(no))
            }
            // The default is the last by habit; one that is not stands for all that follow it.
            None => self.block(frame, state, &first.body),
        }
    }

    fn called(&mut self, function: Handle<Function>, arguments: Vec<Symbol>, state: State) -> (Symbol, State) {
        if self.calls > MOST_CALLS || self.is_full() {
            return (Symbol::Nothing, state);
        }
        let function = &self.module.functions[function];
        self.run(function, arguments, state)
    }

    /// A function's value, and what variables hold after it.
    pub(super) fn run(&mut self, function: &'a Function, arguments: Vec<Symbol>, mut state: State) -> (Symbol, State) {
        self.frames += 1;
        self.calls += 1;
        let mut frame = Frame { function, number: self.frames, arguments, values: HashMap::new() };
        for (local, variable) in function.local_variables.iter() {
            if let Some(init) = variable.init {
                let value = self.expression(&mut frame, &state, init);
                state.insert(Variable::Local(frame.number, local), value);
            }
        }
        let before = state.clone();
        let flow = self.block(&mut frame, state, &function.body);
        let ended = self.ended(flow, &frame);
        self.calls -= 1;
        let (value, mut state) = ended.unwrap_or((None, before));
        state.retain(|variable, _| !matches!(variable, Variable::Local(number, _) if *number == frame.number));
        (value.unwrap_or(Symbol::Nothing), state)
    }

    /// The value and what variables hold at a function's end; none where all is discarded.
    fn ended(&mut self, flow: Flow, frame: &Frame<'a>) -> Option<(Option<Symbol>, State)> {
        match flow {
            Flow::End(End::Return(value), state) => Some((value, state)),
            Flow::End(End::Discard, _) => None,
            Flow::End(_, state) => Some((None, state)),
            Flow::Branch(condition, yes, no) => match (self.ended(*yes, frame), self.ended(*no, frame)) {
                (Some((a, yes)), Some((b, no))) => {
                    let value = match (a, b) {
                        (Some(a), Some(b)) => Some(self.chosen(condition, &a, &b)),
                        (a, b) => a.or(b),
                    };
                    Some((value, self.merged(condition, yes, no, frame.function, frame.number)))
                }
                (yes, no) => yes.or(no),
            },
        }
    }
}

/// How many statements of a loop's body the next turn's head has, where an optimiser left all else of the turn to what ends it.
fn head(body: &[Statement]) -> usize {
    let head = body.iter().take_while(|own| matches!(own, Statement::Emit(_) | Statement::Store { .. })).count();
    let leaves = |block: &[Statement]| matches!(block, [] | [Statement::Break | Statement::Continue]);
    match &body[head..] {
        [Statement::If { accept, reject, .. }] if leaves(accept) && leaves(reject) => head,
        _ => 0,
    }
}

impl Flow {
    fn ends(self, of: &dyn Fn(End) -> End) -> Self {
        match self {
            Self::End(end, state) => Self::End(of(end), state),
            Self::Branch(condition, yes, no) => Self::Branch(condition, Box::new(yes.ends(of)), Box::new(no.ends(of))),
        }
    }

    /// The first turn is taken: what leaves the loop at its head does not.
    fn without_guards(self) -> Self {
        let Self::Branch(condition, yes, no) = self else { return self };
        let (yes, no) = (yes.without_guards(), no.without_guards());
        let leaves = |flow: &Self| matches!(flow, Self::End(End::Break, _));
        match (leaves(&yes), leaves(&no)) {
            (true, false) => no,
            (false, true) => yes,
            _ => Self::Branch(condition, Box::new(yes), Box::new(no)),
        }
    }
}
