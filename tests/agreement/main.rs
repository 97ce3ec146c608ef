//! Every engine and the independent evaluator compute the same.

mod support {
    pub(crate) mod drawing;
    pub(crate) mod oracle;
    pub(crate) mod step_table;
}
