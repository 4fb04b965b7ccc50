//! What texels store other than depth: the papers' and `MATH.md`'s numbers, a million hostile sets of depths, and the
//! shaders against their twins on an adapter.

#[path = "../common/dice.rs"]
#[allow(dead_code, unreachable_pub, reason = "a part of it is used here")]
mod dice;
mod hostile;
mod known;
mod passes;
mod sets;
mod shader;
#[path = "../support/mod.rs"]
mod support;
