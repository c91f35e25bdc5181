//! Adapters and devices, and what goes wrong with them, as errors and not as panics.

use crate::tracer::{Description, TraceError};
use std::sync::{Arc, Mutex, PoisonError};

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
        Ok(Self { device, queue, description: adapter.describe(), trouble })
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
    /// If the device reports an error or is lost.
    pub fn run(&self, encoder: wgpu::CommandEncoder) -> Result<(), TraceError> {
        let submission = self.queue.submit([encoder.finish()]);
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: None };
        let waited = self.device.poll(wait);
        self.check()?;
        waited.map(drop).map_err(|error| TraceError::DeviceLost(error.to_string()))
    }

    /// Whether anything went wrong since the last call.
    ///
    /// # Errors
    /// What went wrong.
    pub fn check(&self) -> Result<(), TraceError> {
        let mut trouble = self.trouble.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(reason) = trouble.lost.take() {
            return Err(TraceError::DeviceLost(reason));
        }
        match trouble.error.take() {
            None => Ok(()),
            Some(wgpu::Error::OutOfMemory { .. }) => Err(TraceError::OutOfMemory(format!(
                "{} could not hold the film",
                self.description.device
            ))),
            Some(error) => Err(TraceError::Device(format!(
                "{} reported an error: {error}",
                self.description.device
            ))),
        }
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
        if reason != wgpu::DeviceLostReason::Destroyed {
            let mut trouble = losses.lock().unwrap_or_else(PoisonError::into_inner);
            trouble.lost.get_or_insert(format!("{reason:?} {message}"));
        }
    });
}
