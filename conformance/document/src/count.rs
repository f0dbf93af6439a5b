//! Counters, which add up field by field.

/// A struct of counts, and the sum of two of them.
macro_rules! counters {
    ($(#[$of:meta])* pub struct $name:ident { $($(#[$of_field:meta])* pub $field:ident: u64,)* }) => {
        $(#[$of])*
        pub struct $name {
            $($(#[$of_field])* pub $field: u64,)*
        }

        impl $name {
            /// Adds another's counts.
            pub const fn add(&mut self, other: &Self) {
                $(self.$field = self.$field.saturating_add(other.$field);)*
            }
        }
    };
}

pub(crate) use counters;
