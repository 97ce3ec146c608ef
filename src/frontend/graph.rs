//! From a drawing to rungs, whatever format it was read from: elements and the wires between them, as a graph.
//!
//! A front end makes a [`diagram::Diagram`] of a body. [`rungs()`] makes its rungs: `order` says what runs when, `vertices`
//! says what each element is in a rung, and `network` makes circuits of them. What both it and the front ends need is here too:
//! `expression`, `types` and `report`. Nothing here knows a format.

pub(super) mod diagram;
pub(super) mod expression;
mod network;
pub(super) mod order;
pub(super) mod pins;
pub(super) mod report;
mod rungs;
pub(super) mod types;
mod vertices;

pub(super) use network::coil_kind;
pub(super) use rungs::rungs;
