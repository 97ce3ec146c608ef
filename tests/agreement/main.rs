//! Every engine and the independent evaluator compute the same: on step tables, on each element, on random programs.

mod arrays;
mod boxes;
mod corpus;
mod elements;
mod examples;
mod faults;
mod guards;
mod jumps;
mod nesting;
mod one_program;
mod passes;
mod presets;
mod random;
mod register_machine;
mod statements;
mod steps;
mod straight_line;
mod tasks;
mod units;

#[path = "../support"]
mod support {
    pub(crate) mod corpus;
    pub(crate) mod coverage;
    pub(crate) mod dice;
    pub(crate) mod drawing;
    pub(crate) mod oracle;
    pub(crate) mod random_program;
    pub(crate) mod random_stimuli;
    pub(crate) mod rig;
    pub(crate) mod same_trace;
    pub(crate) mod script;
    pub(crate) mod shrink;
    pub(crate) mod step_table;
}
