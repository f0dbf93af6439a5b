//! Statements.

use super::{Body, Value};
use crate::rung::writer::is_position;
use naga::{Block, Function, Handle, Statement, SwitchCase, SwitchValue};

impl Body<'_, '_> {
    pub(super) fn block(&mut self, block: &Block) -> Result<(), String> {
        block.iter().try_for_each(|statement| self.statement(statement))
    }

    fn nested(&mut self, head: &str, block: &Block) -> Result<(), String> {
        self.line(&format!("{head} {{"));
        self.depth += 1;
        self.block(block)?;
        self.depth -= 1;
        self.line("}");
        Ok(())
    }

    pub(super) fn statement(&mut self, statement: &Statement) -> Result<(), String> {
        match statement {
            Statement::Emit(range) => range.clone().try_for_each(|value| self.evaluate(value))?,
            Statement::Block(block) => self.nested("", block)?,
            Statement::If { condition, accept, reject } => {
                let condition = self.value(*condition)?;
                self.nested(&format!("if {condition}"), accept)?;
                if !reject.is_empty() {
                    self.nested("else", reject)?;
                }
            }
            Statement::Switch { selector, cases } => self.switch(*selector, cases)?,
            Statement::Loop { body, continuing, break_if } => self.looped(body, continuing, *break_if)?,
            Statement::Break => self.line("break;"),
            Statement::Continue => self.line("continue;"),
            Statement::Kill => self.line("discard;"),
            Statement::Return { value } => {
                let value = value.map_or(Ok(String::new()), |value| self.returned(value))?;
                self.line(&format!("return {value};"));
            }
            Statement::Store { pointer, value } => self.store(*pointer, *value)?,
            Statement::Call { function, arguments, result } => self.call(*function, arguments, *result)?,
            other => return Err(format!("a statement that is not lowered: {other:?}")),
        }
        Ok(())
    }

    fn switch(&mut self, selector: Value, cases: &[SwitchCase]) -> Result<(), String> {
        let selector = self.value(selector)?;
        self.line(&format!("switch {selector} {{"));
        self.depth += 1;
        let mut labels = vec![];
        for case in cases {
            labels.push(match case.value {
                SwitchValue::I32(value) => format!("{value}i"),
                SwitchValue::U32(value) => format!("{value}u"),
                SwitchValue::Default => "default".into(),
            });
            if case.fall_through && case.body.is_empty() {
                continue;
            }
            if case.fall_through {
                return Err("a case falls through".into());
            }
            self.nested(&format!("case {}:", std::mem::take(&mut labels).join(", ")), &case.body)?;
        }
        self.depth -= 1;
        self.line("}");
        Ok(())
    }

    fn looped(&mut self, body: &Block, continuing: &Block, break_if: Option<Value>) -> Result<(), String> {
        self.line("loop {");
        self.depth += 1;
        self.block(body)?;
        if !continuing.is_empty() || break_if.is_some() {
            self.line("continuing {");
            self.depth += 1;
            self.block(continuing)?;
            if let Some(condition) = break_if {
                let condition = self.value(condition)?;
                self.line(&format!("break if {condition};"));
            }
            self.depth -= 1;
            self.line("}");
        }
        self.depth -= 1;
        self.line("}");
        Ok(())
    }

    fn call(&mut self, function: Handle<Function>, arguments: &[Value], result: Option<Value>) -> Result<(), String> {
        let own = self.function.name.clone().unwrap_or_default();
        let called = self.writer.module.functions[function].name.clone().unwrap_or_default();
        let target = self.writer.target(&called, &own);
        let mut texts = vec![];
        for &argument in arguments {
            texts.push(if self.is_pointer(argument) {
                let place = self.place(argument)?;
                if place.is_plain || place.component.is_some() {
                    return Err("a pointer to what is kept in f32 is passed".into());
                }
                format!("&{}", place.text)
            } else {
                self.value(argument)?
            });
        }
        let call = format!("{target}({})", texts.join(", "));
        match result {
            Some(result) => self.bind(result, &call),
            None => self.line(&format!("{call};")),
        }
        Ok(())
    }

    fn store(&mut self, pointer: Value, value: Value) -> Result<(), String> {
        let place = self.place(pointer)?;
        let text = if place.is_position { self.plain(value)? } else { self.value(value)? };
        if let Some(index) = place.component {
            for part in ["hi", "lo"] {
                self.line(&format!("{}.{part}[{index}] = {text}.{part};", place.text));
            }
            return Ok(());
        }
        let text = if place.is_plain && !place.is_position {
            match (self.shape(value), self.handle(value)) {
                (Some(shape), _) => self.writer.dialect.down(shape, &text),
                (None, Some(ty)) => self.writer.convert(ty, &text, false)?,
                (None, None) => text,
            }
        } else {
            text
        };
        self.line(&format!("{} = {text};", place.text));
        Ok(())
    }

    /// What is returned: an entry point's result is f32.
    fn returned(&mut self, value: Value) -> Result<String, String> {
        let Some(result) = self.entry.and_then(|entry| entry.function.result.as_ref()) else {
            return self.value(value);
        };
        if self.raw.contains(&value) {
            return Ok(self.bound[&value].clone());
        }
        if result.binding.as_ref().is_some_and(is_position) {
            return self.plain(value);
        }
        let text = self.value(value)?;
        self.writer.convert(result.ty, &text, false)
    }
}
