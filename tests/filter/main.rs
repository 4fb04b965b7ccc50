//! What filters maps of moments: the passes against their twin in memory, what poison, neighbours and warps do to them,
//! formats on adapters that have them and on those that have not, and what costs nothing.

mod bleeding;
mod bound;
#[path = "../common/dice.rs"]
#[allow(dead_code, unreachable_pub, reason = "a part of it is used here")]
mod dice;
mod fallbacks;
mod formats;
mod left_out;
mod passes;
mod poison;
mod stage;
mod summed;
mod summed_drawn;
#[path = "../support/mod.rs"]
mod support;
mod tiles;
mod width;
