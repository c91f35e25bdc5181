//! Which device renders.

use super::args::DeviceChoice;
use super::{Refusal, refuse};
use crate::cpu::CpuTracer;
use crate::enduring::{Enduring, Listener, Maker};
use crate::gpu::{Adapter, Gpu, GpuTracer, adapters};
use crate::range::Arithmetic;
use crate::scene::Scene;
use crate::tracer::{Description, TraceError, Tracer};
use std::num::NonZeroUsize;

/// What to do where there is no device.
pub(super) const INSTALL_DRIVER: &str = "install a graphics driver (on Debian and Ubuntu \
                                         mesa-vulkan-drivers has one in software)";

/// A device that was found to open.
pub(super) enum Chosen {
    Adapter(Box<Adapter>),
    Twin(Option<NonZeroUsize>),
}

impl Chosen {
    fn of(adapter: Adapter) -> Self {
        Self::Adapter(Box::new(adapter))
    }

    /// A tracer of the scene on this device.
    pub fn tracer(&self, scene: &Scene) -> Result<Box<dyn Tracer>, TraceError> {
        Ok(match self {
            Self::Adapter(adapter) => Box::new(GpuTracer::new(scene, Gpu::open(adapter)?)?),
            Self::Twin(threads) => Box::new(CpuTracer::new(scene, *threads)?),
        })
    }

    /// A tracer of the scene on this device that outlives the device; the same one is opened
    /// again, as another would make other bits. The twin has no device to lose.
    pub fn enduring<'a>(
        &'a self,
        scene: &'a Scene,
        tell: Listener<'a>,
    ) -> Result<Enduring<'a>, TraceError> {
        let make: Maker<'a> = match self {
            Self::Adapter(adapter) => Box::new(|losses| {
                let gpu = if losses == 0 { Gpu::open(adapter) } else { open_again(adapter) }?;
                Ok(Box::new(GpuTracer::new(scene, gpu)?.paced_for(losses)))
            }),
            Self::Twin(_) => Box::new(|_| self.tracer(scene)),
        };
        Enduring::new(make, tell)
    }

    /// Films of a picture that a render on it keeps in this machine's memory at most: the last
    /// whole state, the next one on its way, and an earlier one that is still being written as a
    /// checkpoint; and a tracer's own where it computes on the processor. The twin shares its own
    /// with the state that is taken.
    pub fn films(&self) -> u64 {
        match self {
            Self::Adapter(adapter) if adapter.is_software() => 4,
            Self::Adapter(_) | Self::Twin(_) => 3,
        }
    }

    /// What it computes in.
    pub fn arithmetic(&self) -> Arithmetic {
        match self {
            Self::Adapter(_) => Arithmetic::Single,
            Self::Twin(_) => Arithmetic::Double,
        }
    }

    /// What traces here.
    pub fn describe(&self, scene: &Scene) -> Result<Description, TraceError> {
        match self.adapter() {
            Some(adapter) => Ok(adapter),
            None => Ok(self.tracer(scene)?.describe()),
        }
    }

    /// What it is, if it is a device beside the twin.
    pub fn adapter(&self) -> Option<Description> {
        match self {
            Self::Adapter(adapter) => Some(adapter.describe()),
            Self::Twin(_) => None,
        }
    }
}

/// Chooses as the user asked: `auto` takes the first adapter that opens (hardware comes
/// before software), and the CPU twin where none does.
pub(super) fn choose(
    choice: &DeviceChoice,
    threads: Option<NonZeroUsize>,
) -> Result<Chosen, Refusal> {
    match choice {
        DeviceChoice::Cpu => Ok(Chosen::Twin(threads)),
        DeviceChoice::Auto => {
            Ok(first_that_opens(adapters()).map_or(Chosen::Twin(threads), Chosen::of))
        }
        DeviceChoice::Gpu => match first_that_opens(adapters()) {
            Some(adapter) => Ok(Chosen::of(adapter)),
            None => refuse(format_args!(
                "no Vulkan, Metal or DX12 device here; {INSTALL_DRIVER}, or use --device cpu"
            )),
        },
        DeviceChoice::Named(name) => named(name),
    }
}

fn open_again(adapter: &Adapter) -> Result<Gpu, TraceError> {
    match adapter.again() {
        Some(adapter) => Gpu::open(&adapter),
        None => Err(TraceError::Device(format!(
            "{} ({}) is not there any more",
            adapter.name(),
            adapter.driver()
        ))),
    }
}

fn first_that_opens(adapters: Vec<Adapter>) -> Option<Adapter> {
    adapters.into_iter().find(|adapter| Gpu::open(adapter).is_ok())
}

fn named(name: &str) -> Result<Chosen, Refusal> {
    let all = adapters();
    let wanted = name.to_lowercase();
    let names: Vec<String> = all.iter().map(|adapter| adapter.name().to_owned()).collect();
    match all.into_iter().find(|adapter| adapter.name().to_lowercase().contains(&wanted)) {
        Some(adapter) => Ok(Chosen::of(adapter)),
        None if names.is_empty() => {
            refuse(format_args!("no device named \"{name}\"; there is only --device cpu here"))
        }
        None => refuse(format_args!(
            "no device named \"{name}\"; there are: {}, and --device cpu",
            names.join(", ")
        )),
    }
}
