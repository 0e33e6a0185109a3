//! Functions that code made by Cranelift calls.

use super::{Body, WORD, functions};
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{AbiParam, InstBuilder, StackSlotData, StackSlotKind, Value, types};
use cranelift_module::{Linkage, Module};
use lie_runtime::Elementary;

/// What a function returns and is given.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Unary,
    Binary,
    Family,
}

impl Body<'_, '_> {
    /// `usual` where the test is 0 or above, elsewhere the function.
    pub(super) fn rare(
        &mut self,
        function: Elementary,
        [x, test, usual]: [Value; 3],
    ) -> Option<Value> {
        let zero = self.constant(0.0);
        let compared = self
            .builder
            .ins()
            .fcmp(FloatCC::GreaterThanOrEqual, test, zero);
        let all = match self.shape.number.is_vector() {
            true => self.builder.ins().vall_true(compared),
            false => compared,
        };
        let [beyond, then] = [(); 2].map(|()| self.builder.create_block());
        let result = self.builder.append_block_param(then, self.shape.number);
        self.builder.set_cold_block(beyond);
        self.builder
            .ins()
            .brif(all, then, &[usual.into()], beyond, &[]);
        self.builder.switch_to_block(beyond);
        self.builder.seal_block(beyond);
        let name = functions::name(function.name());
        let mut value = self.function(&name, Kind::Unary, &[x])?;
        if self.shape.number.is_vector() {
            let mask = self.number_of(compared);
            value = self.builder.ins().bitselect(mask, usual, value);
        }
        self.builder.ins().jump(then, &[value.into()]);
        self.builder.switch_to_block(then);
        self.builder.seal_block(then);
        Some(result)
    }

    /// A function of numbers.
    pub(super) fn function(
        &mut self,
        name: &str,
        kind: Kind,
        arguments: &[Value],
    ) -> Option<Value> {
        self.in_lanes(arguments, &mut |body, arguments| {
            body.call(name, kind, arguments)
        })
    }

    /// All functions of a family below an index, each in a register.
    pub(super) fn family(&mut self, name: &str, count: u8, argument: Value) -> Option<()> {
        let bytes = u32::from(count) * WORD as u32;
        let number = self.builder.ins().iconst(types::I64, i64::from(count));
        let mut slots = Vec::new();
        let mut fill = |body: &mut Self, arguments: &[Value]| {
            let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, bytes, 3);
            let slot = body.builder.create_sized_stack_slot(slot);
            let place = body.builder.ins().stack_addr(types::I64, slot, 0);
            body.call(name, Kind::Family, &[number, arguments[0], place]);
            slots.push(slot);
            Some(arguments[0])
        };
        self.in_lanes(&[argument], &mut fill)?;
        for index in 0..i32::from(count) {
            let builder = &mut self.builder;
            let values: Vec<Value> = slots
                .iter()
                .map(|slot| builder.ins().stack_load(types::F64, *slot, index * WORD))
                .collect();
            let value = match values[..] {
                [first, second] => self.both(first, second),
                _ => values[0],
            };
            self.registers.push(value);
        }
        Some(())
    }

    /// Calls a function of ours; its result, if it has one.
    fn call(&mut self, name: &str, kind: Kind, arguments: &[Value]) -> Option<Value> {
        let function = match self.called.get(name) {
            Some(function) => *function,
            None => {
                let mut signature = self.module.make_signature();
                let number = AbiParam::new(types::F64);
                let word = AbiParam::new(types::I64);
                signature.params = match kind {
                    Kind::Unary => vec![number],
                    Kind::Binary => vec![number; 2],
                    Kind::Family => vec![word, number, word],
                };
                if !matches!(kind, Kind::Family) {
                    signature.returns.push(number);
                }
                let module = &mut self.module;
                let declared = module
                    .declare_function(name, Linkage::Import, &signature)
                    .ok()?;
                let function = module.declare_func_in_func(declared, self.builder.func);
                self.called.insert(name.to_owned(), function);
                function
            }
        };
        let call = self.builder.ins().call(function, arguments);
        self.builder.inst_results(call).first().copied()
    }
}
