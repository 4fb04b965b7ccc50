//! Formats on devices that have not all features: what is chosen instead, and that it works there.

use core::pin::pin;
use core::task::{Context, Poll, Waker};

use antumbra::gpu::{self, wgpu};
use antumbra::lab::gpu::Gpu;
use antumbra::{MapBudget, Moments, Radius, Remix, techniques};

use crate::stage::{Stage, encoding, fit, key_of};

/// What a future that is ready says: errors are there as soon as they are made.
fn at_once<Value>(future: impl Future<Output = Value>) -> Value {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(value) => value,
        Poll::Pending => panic!("a native device answers at once"),
    }
}

/// Features that formats of moments need, together and alone.
fn sets() -> Vec<wgpu::Features> {
    let [linear, norm, drawn] = [
        wgpu::Features::FLOAT32_FILTERABLE,
        wgpu::Features::TEXTURE_FORMAT_16BIT_NORM,
        wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES,
    ];
    vec![wgpu::Features::empty(), linear, norm, drawn, norm | drawn, linear | norm, linear | norm | drawn]
}

/// Whatever is asked for and whatever a device has: what is chosen keeps the same moments, needs no more than there is,
/// and is what was asked for where that can be.
#[test]
fn fallbacks_are_legal() {
    for features in sets() {
        for wanted in Moments::all() {
            let chosen = gpu::supported(wanted, features);
            assert_eq!((chosen.kind(), chosen.mips), (wanted.kind(), wanted.mips));
            assert!(
                features.contains(gpu::required_features(key_of(chosen))),
                "{wanted:?}: {chosen:?} of {features:?}"
            );
            let can = features.contains(gpu::required_features(key_of(wanted)));
            assert!(!can || chosen.format() == wanted.format(), "{wanted:?}: {chosen:?} of {features:?}");
            // Samplers are never asked for what the device refuses, and always where it grants it.
            assert_eq!(gpu::supported(chosen, features), chosen);
        }
    }
}

/// On devices with none of the features, and with some of them, what is chosen draws the picture that the rest draws.
#[test]
fn fallbacks_work() {
    let Some(full) = Stage::new() else { return };
    let most = full.gpu.device().features();
    let map = MapBudget::one(256);
    for features in sets() {
        let device = Gpu::with_features(features).expect("the adapter that there was");
        // Only what was wished for, and that the adapter has.
        assert!(sets().iter().all(|set| !device.device().features().intersects(*set - (features & most))));
        let stage = Stage::on(device);
        let features = stage.gpu.device().features();
        let mut drawn: Vec<(Moments, Vec<u8>)> = Vec::new();
        for wanted in Moments::all() {
            let chosen = gpu::supported(wanted, features);
            if drawn.iter().any(|(moments, _)| *moments == chosen) {
                continue;
            }
            let remix = Remix { encoding: encoding(chosen, Radius::Texels(1.5), false), ..techniques::fsm() };
            let frame = fit(&remix, map);
            let scope = stage.gpu.device().push_error_scope(wgpu::ErrorFilter::Validation);
            let picture = stage.picture(&frame);
            let error = at_once(scope.pop());
            assert!(error.is_none(), "{chosen:?} of {features:?}: {error:?}");
            assert!(picture.iter().filter(|lit| **lit < 60).count() > 300, "{chosen:?}");
            drawn.push((chosen, picture));
        }
        println!("{features:?}: {} ways to keep moments", drawn.len());
    }
}

/// What is said to be needed is what the device refuses to do without, and no more: with it no error, without each
/// part of it one.
#[test]
fn features_are_those_that_devices_demand() {
    let Some(full) = Stage::new() else { return };
    let most = full.gpu.device().features();
    let devices: Vec<Stage> = sets()
        .into_iter()
        .filter(|set| most.contains(*set))
        .map(|set| Stage::on(Gpu::with_features(set).expect("the adapter that there was")))
        .collect();
    let (mut refused, mut granted) = (0, 0);
    for moments in Moments::all().filter(|moments| !moments.mips) {
        let remix = Remix { encoding: encoding(moments, Radius::Texels(1.5), false), ..techniques::fsm() };
        let frame = fit(&remix, MapBudget::one(32));
        let needed = gpu::required_features(frame.wgsl);
        for stage in &devices {
            let scope = stage.gpu.device().push_error_scope(wgpu::ErrorFilter::Validation);
            let maps = stage.maps(&frame);
            drop(maps);
            let error = at_once(scope.pop());
            let has = stage.gpu.device().features().contains(needed);
            assert_eq!(error.is_none(), has, "{moments:?} of {:?}: {error:?}", stage.gpu.device().features());
            if has { granted += 1 } else { refused += 1 }
        }
    }
    println!("{granted} granted, {refused} refused, on {} devices", devices.len());
    assert!(granted > 20 && refused > 20);
}
