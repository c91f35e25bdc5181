//! Waiting for a device. wgpu panics where a wait finds that the device is lost, which is how
//! most losses show: a driver's watchdog ends a dispatch while it is waited for.

use crate::tracer::TraceError;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

/// One wait takes no longer: a process that was stopped for an hour finds one of its waits at an
/// end when it goes on, not its patience.
const SLICE: Duration = Duration::from_secs(1);

thread_local! {
    static POLLING: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread waits for a device. A panic is caught then and becomes
/// [`TraceError::DeviceLost`]: whoever reports panics has nothing to report.
#[must_use]
pub fn is_polling() -> bool {
    POLLING.get()
}

/// Polls the device.
///
/// # Errors
/// If it is lost.
pub(super) fn poll(
    device: &wgpu::Device,
    how: wgpu::PollType,
) -> Result<Result<wgpu::PollStatus, wgpu::PollError>, TraceError> {
    POLLING.set(true);
    // wgpu has done its work and released its locks by the time that it panics.
    let polled = catch_unwind(AssertUnwindSafe(|| device.poll(how)));
    POLLING.set(false);
    polled.map_err(|panic| {
        let text = panic.downcast_ref::<String>().map_or("unknown", String::as_str);
        TraceError::DeviceLost(text.to_owned())
    })
}

/// Waits for a submission; whether it was finished within `patience`.
///
/// # Errors
/// If the device is lost.
pub(super) fn wait(
    device: &wgpu::Device,
    submission: &wgpu::SubmissionIndex,
    patience: Duration,
) -> Result<bool, TraceError> {
    let mut left = patience;
    while !left.is_zero() {
        let slice = left.min(SLICE);
        let how = wgpu::PollType::Wait {
            submission_index: Some(submission.clone()),
            timeout: Some(slice),
        };
        match poll(device, how)? {
            Ok(_) => return Ok(true),
            Err(wgpu::PollError::Timeout) => left -= slice,
            Err(wgpu::PollError::WrongSubmissionIndex(..)) => {
                // A device that takes no more work; this poll lets it say why.
                poll(device, wgpu::PollType::Poll)?.ok();
                return Err(TraceError::DeviceLost("it takes no more work".to_owned()));
            }
        }
    }
    Ok(false)
}
