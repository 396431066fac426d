//! The checks: what is counted of a mesh besides its measures.

use serde::{Deserialize, Serialize};

/// Makes the struct and the lookup by name from one list.
macro_rules! checks {
    (always { $($(#[$doc:meta])* $name:ident,)+ } costly { $($(#[$costly_doc:meta])* $costly:ident,)+ }) => {
        /// Number of findings of each check.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
        pub struct Checks {
            $(
                $(#[$doc])*
                #[serde(default)]
                pub $name: u64,
            )+
            $(
                $(#[$costly_doc])*
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub $costly: Option<u64>,
            )+
        }

        impl Checks {
            /// The names of the checks, as the summary has them.
            pub const NAMES: &[&str] = &[$(stringify!($name),)+ $(stringify!($costly)),+];
            /// The names of those that are made only if somebody asks for all.
            pub const COSTLY: &[&str] = &[$(stringify!($costly)),+];

            /// The number of findings of the check of that name.
            pub fn get(&self, name: &str) -> Option<u64> {
                match name {
                    $(stringify!($name) => Some(self.$name),)+
                    $(stringify!($costly) => self.$costly,)+
                    _ => None,
                }
            }
        }
    };
}

checks! {
    always {
        /// Elements that name nodes which the file does not define; they were left out.
        missing_nodes,
        /// Elements that name one corner twice.
        repeated_nodes,
        /// Nodes that no element names.
        unused_nodes,
        /// Elements that are oriented against the majority of their shape.
        inverted,
        /// Elements without area or volume, or with an edge without length.
        degenerate,
        /// Elements of shapes whose majority is oriented negatively: a convention of the writer, not a fault.
        reversed,
        /// Quadrilateral faces with a re-entrant corner.
        concave_faces,
        /// Quadrilateral faces two of whose sides cross.
        crossed_faces,
        /// Elements that another partition has as its own, or that the file hides; they were left out.
        ghost_elements,
    }
    costly {
        /// Measured elements that have the shape and the corners of another that is counted already.
        duplicate_elements,
        /// Nodes that stand exactly where another stands that is counted already.
        coincident_nodes,
    }
}
