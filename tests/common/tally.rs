//! What a property counts while it runs, so that the test around it can say what its inputs reached.

use std::sync::atomic::{AtomicU32, Ordering};

/// `N` numbers, from zero on.
pub struct Tally<const N: usize>([AtomicU32; N]);

impl<const N: usize> Tally<N> {
    pub const fn new() -> Self {
        Self([const { AtomicU32::new(0) }; N])
    }

    /// Adds one to a number.
    pub fn count(&self, which: usize) {
        self.0[which].fetch_add(1, Ordering::Relaxed);
    }

    /// Raises a number to a value, where it is less.
    pub fn raise(&self, which: usize, value: u32) {
        self.0[which].fetch_max(value, Ordering::Relaxed);
    }

    /// The numbers as they are now.
    pub fn read(&self) -> [u32; N] {
        self.0.each_ref().map(|number| number.load(Ordering::Relaxed))
    }
}
