//! What averaging moments costs: light where there is none, shadow where there is none, flicker.

mod drawn;
mod encodings;
mod fence;
mod planes;
mod section;
mod stack;
mod warped;
