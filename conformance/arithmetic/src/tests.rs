//! The arithmetics against oracles that share no code with them: integers, the grids of the formats, known derivatives.

mod accept;
mod builtins;
mod chains;
mod dual;
mod fixed;
mod format;
mod mistaken;
mod oracle;
mod paths;
mod profile;
mod random;
mod trace;
