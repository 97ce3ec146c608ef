//! Rung inside another program: as a library, and as an object that is linked.

mod controller;
mod embed;
mod linked;
