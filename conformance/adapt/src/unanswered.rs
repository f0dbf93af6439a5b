//! What leaves a case without a value: a fragment that is discarded, and a loop that does not end.

use crate::name::safe;
use naga::{
    AddressSpace, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal, Module, Scalar, Span,
    Statement, Type, TypeInner,
};

/// How often the loops of a shader turn for one case, all together, before the case is left without a value.
///
/// No lighting of a case needs as many, and it is below what lavapipe ends loops at by itself (65,535).
pub const MOST_TURNS: u32 = 16_384;

/// What may leave a case of a shader without a value.
#[derive(Clone, Debug, Default)]
pub(crate) struct Unanswered {
    /// The variable that says whether the case has no value; `None` of a shader that always has one.
    pub(crate) flag: Option<String>,
    /// Statements that make ready for the next case: an invocation may evaluate several.
    pub(crate) reset: Vec<String>,
    pub(crate) discards: bool,
    pub(crate) loops: bool,
}

/// Has a shader set a variable and return, where it would discard its fragment, and leave its loops after [`MOST_TURNS`].
pub(crate) fn unanswered(module: &mut Module) -> Unanswered {
    let has = |test: fn(&Statement) -> bool| module.functions.iter().any(|(_, function)| any(&function.body, &test));
    let (discards, loops) = (has(is_discard), has(is_loop));
    if !discards && !loops {
        return Unanswered::default();
    }
    let flag = private(module, "unanswered", Scalar::BOOL);
    let turns = loops.then(|| private(module, "turns", Scalar::U32));
    for (_, function) in module.functions.iter_mut() {
        if any(&function.body, &is_discard) {
            let mut add = |expression| function.expressions.append(expression, Span::UNDEFINED);
            let (pointer, truth) =
                (add(Expression::GlobalVariable(flag)), add(Expression::Literal(Literal::Bool(true))));
            let value = function.result.as_ref().map(|result| add(Expression::ZeroValue(result.ty)));
            let instead = [Statement::Store { pointer, value: truth }, Statement::Return { value }];
            let body = std::mem::take(&mut function.body);
            function.body = returning(body, &instead);
        }
        if let Some(turns) = turns {
            count_turns(function, turns, flag);
        }
    }
    let name = |name: &str, variable: Handle<GlobalVariable>| safe("global", Some(name), variable.index());
    let flag = name("unanswered", flag);
    let mut reset = vec![format!("{flag} = false;")];
    reset.extend(turns.map(|turns| format!("{} = 0u;", name("turns", turns))));
    Unanswered { flag: Some(flag), reset, discards, loops }
}

/// Adds a variable of the invocation, which begins as zero.
fn private(module: &mut Module, name: &str, scalar: Scalar) -> Handle<GlobalVariable> {
    let ty = module.types.insert(Type { name: None, inner: TypeInner::Scalar(scalar) }, Span::UNDEFINED);
    let variable = GlobalVariable {
        name: Some(name.into()),
        space: AddressSpace::Private,
        binding: None,
        ty,
        init: None,
        memory_decorations: naga::MemoryDecorations::empty(),
    };
    module.global_variables.append(variable, Span::UNDEFINED)
}

fn is_discard(statement: &Statement) -> bool {
    matches!(statement, Statement::Kill)
}

fn is_loop(statement: &Statement) -> bool {
    matches!(statement, Statement::Loop { .. })
}

/// Whether a block has such a statement, at any depth.
fn any(block: &Block, test: &impl Fn(&Statement) -> bool) -> bool {
    block.iter().any(|statement| {
        test(statement)
            || match statement {
                Statement::Block(block) => any(block, test),
                Statement::If { accept, reject, .. } => any(accept, test) || any(reject, test),
                Statement::Switch { cases, .. } => cases.iter().any(|case| any(&case.body, test)),
                Statement::Loop { body, continuing, .. } => any(body, test) || any(continuing, test),
                _ => false,
            }
    })
}

/// A block in which every block within is changed.
fn within(statement: Statement, change: &mut impl FnMut(Block) -> Block) -> Statement {
    match statement {
        Statement::Block(block) => Statement::Block(change(block)),
        Statement::If { condition, accept, reject } => {
            Statement::If { condition, accept: change(accept), reject: change(reject) }
        }
        Statement::Switch { selector, mut cases } => {
            for case in &mut cases {
                case.body = change(std::mem::take(&mut case.body));
            }
            Statement::Switch { selector, cases }
        }
        Statement::Loop { body, continuing, break_if } => {
            Statement::Loop { body: change(body), continuing: change(continuing), break_if }
        }
        other => other,
    }
}

/// A block with other statements in place of each discard.
fn returning(block: Block, instead: &[Statement]) -> Block {
    let mut out = Block::new();
    for (statement, span) in block.span_into_iter() {
        if is_discard(&statement) {
            instead.iter().for_each(|one| out.push(one.clone(), span));
            return out;
        }
        out.push(within(statement, &mut |block| returning(block, instead)), span);
    }
    out
}

/// Has each turn of a function's loops counted, and each loop left where there are too many of them.
fn count_turns(function: &mut Function, turns: Handle<GlobalVariable>, flag: Handle<GlobalVariable>) {
    let mut body = std::mem::take(&mut function.body);
    body = counted(body, &mut || {
        let mut add = |expression| function.expressions.append(expression, Span::UNDEFINED);
        let (pointer, flag) = (add(Expression::GlobalVariable(turns)), add(Expression::GlobalVariable(flag)));
        let (one, most) =
            (add(Expression::Literal(Literal::U32(1))), add(Expression::Literal(Literal::U32(MOST_TURNS))));
        let value = add(Expression::Literal(Literal::Bool(true)));
        let before = function.expressions.len();
        let mut add = |expression| function.expressions.append(expression, Span::UNDEFINED);
        let left = add(Expression::Load { pointer });
        let next = add(Expression::Binary { op: BinaryOperator::Add, left, right: one });
        let condition = add(Expression::Binary { op: BinaryOperator::Greater, left: next, right: most });
        let leave = Block::from_vec(vec![Statement::Store { pointer: flag, value }, Statement::Break]);
        vec![
            Statement::Emit(function.expressions.range_from(before)),
            Statement::Store { pointer, value: next },
            Statement::If { condition, accept: leave, reject: Block::new() },
        ]
    });
    function.body = body;
}

/// A block, each of whose loops begins its turns with statements made for it.
fn counted(block: Block, first: &mut impl FnMut() -> Vec<Statement>) -> Block {
    let mut out = Block::new();
    for (statement, span) in block.span_into_iter() {
        let mut statement = within(statement, &mut |block| counted(block, first));
        if let Statement::Loop { body, .. } = &mut statement {
            let mut turn = Block::from_vec(first());
            turn.append(body);
            *body = turn;
        }
        out.push(statement, span);
    }
    out
}
