//! Adapters and devices, and what goes wrong with them, as errors and not as panics.

use super::poll::{poll, wait};
use crate::tracer::{Description, TraceError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A dispatch that takes longer will not end. It is planned to take a tenth of a second, a
/// thousandth of this ([`super::pace`]). The rest is for the first one: nothing is known of the
/// device yet, it may be one in software on a machine with other work, and some drivers compile
/// the kernel only then.
const PATIENCE: Duration = Duration::from_mins(2);

/// Something that could trace: one adapter of the graphics API.
#[derive(Debug, Clone)]
pub struct Adapter {
    adapter: wgpu::Adapter,
    info: wgpu::AdapterInfo,
}

impl Adapter {
    /// Name of the device, as its driver gives it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// Graphics API, driver and its version.
    #[must_use]
    pub fn driver(&self) -> String {
        format!("{}, {} {}", self.info.backend, self.info.driver, self.info.driver_info)
            .trim_end()
            .to_owned()
    }

    /// Whether it computes on this machine's processor.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// What kind of device it is, in words.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self.info.device_type {
            wgpu::DeviceType::DiscreteGpu => "discrete GPU",
            wgpu::DeviceType::IntegratedGpu => "integrated GPU",
            wgpu::DeviceType::VirtualGpu => "virtual GPU",
            wgpu::DeviceType::Cpu => "software",
            wgpu::DeviceType::Other => "GPU",
        }
    }

    /// The same adapter, asked for anew: after a device was lost, nothing that the driver said
    /// before need hold. `None` if it is not there any more.
    #[must_use]
    pub fn again(&self) -> Option<Self> {
        adapters().into_iter().find(|adapter| adapter.info == self.info)
    }

    /// What traces, for messages and film headers.
    #[must_use]
    pub fn describe(&self) -> Description {
        Description {
            device: self.info.name.clone(),
            driver: self.driver(),
            software: self.is_software(),
        }
    }
}

/// All adapters of Vulkan, Metal and DX12: hardware first, in the order of the API.
#[must_use]
pub fn adapters() -> Vec<Adapter> {
    let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let mut adapters: Vec<Adapter> = pollster::block_on(instance.enumerate_adapters(backends))
        .into_iter()
        .map(|adapter| Adapter { info: adapter.get_info(), adapter })
        .collect();
    adapters.sort_by_key(|adapter| match adapter.info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other => 2,
        wgpu::DeviceType::Cpu => 3,
    });
    adapters
}

/// What the device reported behind our back.
#[derive(Debug, Default)]
struct Trouble {
    /// Why the device is lost; it stays so.
    lost: Option<String>,
    error: Option<wgpu::Error>,
}

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    description: Description,
    trouble: Arc<Mutex<Trouble>>,
    patience: Duration,
}

impl Gpu {
    /// Opens a device of an adapter.
    ///
    /// # Errors
    /// If the driver refuses, or lacks WebGPU's default limits.
    pub fn open(adapter: &Adapter) -> Result<Self, TraceError> {
        let offered = adapter.adapter.limits();
        let limits = wgpu::Limits {
            max_buffer_size: offered.max_buffer_size,
            max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        };
        let request = adapter.adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("candor"),
            required_limits: limits,
            ..wgpu::DeviceDescriptor::default()
        });
        let (device, queue) = pollster::block_on(request).map_err(|error| {
            TraceError::Device(format!("cannot use {}: {error}", adapter.name()))
        })?;
        let trouble = Arc::new(Mutex::new(Trouble::default()));
        watch(&device, &trouble);
        Ok(Self { device, queue, description: adapter.describe(), trouble, patience: PATIENCE })
    }

    /// The same device, given up for lost when a dispatch takes longer than `patience`.
    #[must_use]
    pub fn with_patience(self, patience: Duration) -> Self {
        Self { patience, ..self }
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Its queue.
    #[must_use]
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// What it is.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Submits commands and waits until the device has finished them.
    ///
    /// # Errors
    /// If the device reports an error or is lost; a device that does not finish them is given up
    /// for lost.
    pub fn run(&self, encoder: wgpu::CommandEncoder) -> Result<(), TraceError> {
        let submission = self.queue.submit([encoder.finish()]);
        let waited = wait(&self.device, &submission, self.patience);
        self.check()?;
        if waited? {
            return Ok(());
        }
        self.leak();
        let reason = format!("it did not finish within {} s", self.patience.as_secs_f64());
        self.trouble().lost = Some(reason.clone());
        Err(TraceError::DeviceLost(reason))
    }

    /// Keeps the device open until the program ends. The destructor of a queue waits until it is
    /// idle, so that of a queue that hangs may never return.
    fn leak(&self) {
        std::mem::forget((self.device.clone(), self.queue.clone()));
    }

    /// Whether anything went wrong since the last call, or the device is lost.
    ///
    /// # Errors
    /// What went wrong.
    pub fn check(&self) -> Result<(), TraceError> {
        let error = {
            let mut trouble = self.trouble();
            if let Some(reason) = &trouble.lost {
                return Err(TraceError::DeviceLost(reason.clone()));
            }
            let Some(error) = trouble.error.take() else { return Ok(()) };
            error
        };
        // Nothing fits a device that was destroyed, and a poll is what tells of that.
        let _ = poll(&self.device, wgpu::PollType::Poll);
        if let Some(reason) = &self.trouble().lost {
            return Err(TraceError::DeviceLost(reason.clone()));
        }
        let device = &self.description.device;
        Err(match error {
            wgpu::Error::OutOfMemory { .. } => {
                TraceError::OutOfMemory(format!("{device} could not hold the film"))
            }
            error => TraceError::Device(format!("{device} reported an error: {error}")),
        })
    }

    /// What it means that a buffer cannot be mapped, which nothing but a lost device explains:
    /// why it is lost, or `sign` where that is not known.
    pub(super) fn unmapped(&self, sign: String) -> TraceError {
        let _ = poll(&self.device, wgpu::PollType::Poll);
        self.check().err().unwrap_or(TraceError::DeviceLost(sign))
    }

    fn trouble(&self) -> MutexGuard<'_, Trouble> {
        self.trouble.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// wgpu would panic on an error that nobody asked for; here it is kept for [`Gpu::check`].
fn watch(device: &wgpu::Device, trouble: &Arc<Mutex<Trouble>>) {
    let errors = Arc::clone(trouble);
    device.on_uncaptured_error(Arc::new(move |error| {
        errors.lock().unwrap_or_else(PoisonError::into_inner).error.get_or_insert(error);
    }));
    let losses = Arc::clone(trouble);
    device.set_device_lost_callback(move |reason, message| {
        let text = match reason {
            wgpu::DeviceLostReason::Destroyed => "it was destroyed".to_owned(),
            wgpu::DeviceLostReason::Unknown => format!("its driver reports: {message}"),
        };
        losses.lock().unwrap_or_else(PoisonError::into_inner).lost.get_or_insert(text);
    });
}
