//! What is published, and what its documents say: pages, packages, peers.

#[path = "../common/mod.rs"]
mod common;

mod packages;
mod pages;
mod peers;
