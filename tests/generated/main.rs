//! Generated code: the committed one, and the same from the macro and from a spec.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/items.rs"]
mod items;

mod golden;
mod macro_equals_spec;
