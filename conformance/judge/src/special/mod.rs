//! What drivers were seen to make of special values.

pub mod record;
