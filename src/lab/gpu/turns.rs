//! Pictures drawn turn by turn, so that other work on the machine meets all of them alike.

use super::clock::{PassTimes, Stopwatch};
use super::render::Shot;
use super::{Gpu, GpuFailure, GpuImage, GpuScene, Renderer};
use crate::camera::Camera;
use crate::frame::ShadowFrame;
use crate::gpu::ShadowMaps;

/// What takes part.
#[derive(Clone, Copy, Debug)]
pub struct Entrant<'a> {
    /// Pipelines of the frame's key.
    pub renderer: &'a Renderer,
    /// What was fitted.
    pub frame: &'a ShadowFrame,
    /// The maps that it is drawn into, its own.
    pub maps: &'a ShadowMaps,
}

/// What an entrant drew.
#[derive(Clone, Debug, PartialEq)]
pub struct Turns {
    /// The picture, with the median of each pass.
    pub image: GpuImage,
    /// Times of every turn, in order; turns of one index were drawn one after the other.
    pub times: Vec<PassTimes>,
}

impl<'a> Entrant<'a> {
    /// Uploads, and draws everything once.
    fn ready(
        &self,
        gpu: &'a Gpu,
        scene: &'a GpuScene,
        camera: &Camera,
        stopwatch: &Stopwatch,
    ) -> Result<Shot<'a>, GpuFailure> {
        let shot = Shot::new(self.renderer, gpu, scene, camera, self.frame, self.maps)?;
        stopwatch.time(|encoder, _| shot.depth_pass(encoder))?;
        shot.turn(stopwatch)?;
        Ok(shot)
    }
}

/// Draws every entrant once untimed, and then `turns` times (at least once), in alternating order.
///
/// One that fails leaves the others alone; its error is as of [`Renderer::render`].
#[must_use]
pub fn draw_in_turns(
    gpu: &Gpu,
    scene: &GpuScene,
    camera: &Camera,
    entrants: &[Entrant],
    turns: u32,
) -> Vec<Result<Turns, GpuFailure>> {
    // Draw all once: whoever comes first pays for the caches, and new memory is slow.
    let stopwatch = Stopwatch::new(gpu);
    let mut tracks: Vec<Result<(Shot, Vec<PassTimes>), GpuFailure>> =
        entrants.iter().map(|entrant| Ok((entrant.ready(gpu, scene, camera, &stopwatch)?, Vec::new()))).collect();
    // Take turns.
    for turn in 0..turns.max(1) {
        for place in 0..tracks.len() {
            let place = if turn % 2 == 0 { place } else { tracks.len() - 1 - place };
            let Ok((shot, times)) = &mut tracks[place] else { continue };
            match shot.turn(&stopwatch) {
                Ok(time) => times.push(time),
                Err(error) => tracks[place] = Err(error),
            }
        }
    }
    let picture = |track: Result<(Shot, Vec<PassTimes>), GpuFailure>| {
        let (shot, times) = track?;
        let timings = PassTimes::median(&times, stopwatch.clock());
        Ok(Turns { image: GpuImage { size: camera.viewport, mask: shot.read_mask()?, timings }, times })
    };
    tracks.into_iter().map(picture).collect()
}
