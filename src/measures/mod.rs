//! The twelve measures.
