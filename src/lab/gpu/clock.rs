//! Timing of passes: by the GPU's own clock where it has one, else by the wall clock around submission and completion.

use std::time::Instant;

use super::{Gpu, GpuFailure, readback};
use crate::lab::statistics::quantile;

/// Which clock measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// The GPU's, at the beginning and the end of a pass.
    Timestamps,
    /// The CPU's, from submission to completion.
    Wall,
}

/// Times of one picture, milliseconds; medians over the repetitions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTimes {
    /// Drawing casters into the maps.
    pub casters_ms: f64,
    /// Filtering the maps; 0 for depth maps, which need none.
    pub filter_ms: f64,
    /// Shading receivers, over a depth buffer that is already there.
    pub receivers_ms: f64,
    /// The clock.
    pub clock: Clock,
}

impl PassTimes {
    /// Each pass's median over repetitions; NaN of none.
    #[must_use]
    pub fn median(times: &[Self], clock: Clock) -> Self {
        let of = |pass: fn(&Self) -> f64| quantile(&times.iter().map(pass).collect::<Vec<_>>(), 0.5);
        let (casters_ms, filter_ms) = (of(|times| times.casters_ms), of(|times| times.filter_ms));
        Self { casters_ms, filter_ms, receivers_ms: of(|times| times.receivers_ms), clock }
    }
}

/// Times submissions one by one.
pub(super) struct Stopwatch<'a> {
    gpu: &'a Gpu,
    queries: Option<Queries>,
}

struct Queries {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: wgpu::Buffer,
}

/// Two timestamps.
const STAMPS: u32 = 2;
/// Bytes of them.
const STAMP_BYTES: u64 = 2 * size_of::<u64>() as u64;

/// The timestamps of one submission, handed to its passes.
#[derive(Clone, Copy)]
pub(super) struct Stamps<'a> {
    set: Option<&'a wgpu::QuerySet>,
}

impl<'a> Stamps<'a> {
    /// For pass `index` of `count`: the first writes the beginning, the last the end.
    pub(super) fn of_pass(self, index: usize, count: usize) -> Option<wgpu::RenderPassTimestampWrites<'a>> {
        let first = (index == 0).then_some(0);
        let last = (index + 1 == count).then_some(1);
        if first.is_none() && last.is_none() {
            return None;
        }
        self.set.map(|query_set| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: first,
            end_of_pass_write_index: last,
        })
    }
}

impl<'a> Stopwatch<'a> {
    /// By the GPU's clock if it has one.
    pub(super) fn new(gpu: &'a Gpu) -> Self {
        let queries = gpu.has_timestamps().then(|| {
            let buffer = |label, usage| {
                let size = STAMP_BYTES;
                gpu.device().create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
            };
            let set = gpu.device().create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("stopwatch"),
                ty: wgpu::QueryType::Timestamp,
                count: STAMPS,
            });
            let resolved = buffer(Some("timestamps"), wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC);
            let read = buffer(Some("timestamps, read"), wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
            Queries { set, resolved, read }
        });
        Self { gpu, queries }
    }

    /// The clock it measures by.
    pub(super) fn clock(&self) -> Clock {
        if self.queries.is_some() { Clock::Timestamps } else { Clock::Wall }
    }

    /// Records, submits and waits; the time between the stamps, or around all of it, in milliseconds.
    pub(super) fn time(&self, record: impl FnOnce(&mut wgpu::CommandEncoder, Stamps)) -> Result<f64, GpuFailure> {
        let set = self.queries.as_ref().map(|queries| &queries.set);
        let mut encoder = self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        record(&mut encoder, Stamps { set });
        let commands = encoder.finish();
        // Nothing else may be running.
        self.gpu.wait()?;
        let start = Instant::now();
        self.gpu.queue().submit([commands]);
        self.gpu.wait()?;
        let wall = start.elapsed().as_secs_f64() * 1e3;
        self.queries.as_ref().map_or(Ok(wall), |queries| self.between(queries))
    }

    /// Time between the two stamps, milliseconds.
    fn between(&self, queries: &Queries) -> Result<f64, GpuFailure> {
        let mut encoder = self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.resolve_query_set(&queries.set, 0..STAMPS, &queries.resolved, 0);
        encoder.copy_buffer_to_buffer(&queries.resolved, 0, &queries.read, 0, STAMP_BYTES);
        self.gpu.queue().submit([encoder.finish()]);
        let bytes = readback::map(self.gpu, &queries.read)?;
        let stamp = |index: usize| u64::from_le_bytes(core::array::from_fn(|byte| bytes[8 * index + byte]));
        let ticks = stamp(1).saturating_sub(stamp(0));
        // 2^53 ticks are months: exact.
        let nanoseconds = ticks as f64 * f64::from(self.gpu.queue().get_timestamp_period());
        Ok(nanoseconds * 1e-6)
    }
}
