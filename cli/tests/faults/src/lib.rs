//! A Vulkan layer for tests that makes a driver fail in one of the ways of real drivers.
//!
//! Vulkan's loader puts it between the program and the driver. The variable `PINHOLE_TEST_FAULT` chooses the fault:
//!
//! * `lost-submit=N`: the N-th submission and everything after it reports a lost device.
//! * `lost-wait=N`: the N-th submission is accepted and never done; everything after it reports a lost device.
//! * `hang=N`: the N-th submission and those after it are accepted and never done.
//! * `memory=BYTES`: allocations that would exceed this sum are refused.
//!
//! Only one device of a process may be open at a time.
#![allow(unsafe_code, reason = "Vulkan's layers are called with pointers, and call functions by pointers")]

use std::collections::HashMap;
use std::ffi::{CStr, c_char, c_void};
use std::mem::transmute;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use ash::vk;
use ash::vk::Handle;

/// A way to fail.
#[derive(Clone, Copy)]
enum Fault {
    LostSubmit(u64),
    LostWait(u64),
    Hang(u64),
    Memory(u64),
}

impl Fault {
    fn from_environment() -> Option<Self> {
        let text = std::env::var("PINHOLE_TEST_FAULT").ok()?;
        let (name, number) = text.split_once('=')?;
        let number = number.parse().ok()?;
        Some(match name {
            "lost-submit" => Self::LostSubmit(number),
            "lost-wait" => Self::LostWait(number),
            "hang" => Self::Hang(number),
            "memory" => Self::Memory(number),
            _ => return None,
        })
    }
}

static STATE: Mutex<State> = Mutex::new(State {
    fault: Fault::Memory(u64::MAX),
    next_of_instance: None,
    next_of_device: None,
    submissions: 0,
    is_lost: false,
    allocated: None,
});

struct State {
    fault: Fault,
    /// Finds functions of the driver, or of the next layer below this one.
    next_of_instance: Option<(vk::PFN_vkGetInstanceProcAddr, vk::Instance)>,
    next_of_device: Option<(vk::PFN_vkGetDeviceProcAddr, vk::Device)>,
    submissions: u64,
    is_lost: bool,
    /// Number of bytes of each allocation.
    allocated: Option<HashMap<u64, u64>>,
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the driver's function of this name. `F` must be the type of the function.
unsafe fn next<F: Copy>(name: &CStr) -> F {
    let next = state().next_of_device;
    let found = next.and_then(|(find, device)| unsafe { find(device, name.as_ptr()) });
    let Some(found) = found else { std::process::abort() };
    unsafe { std::mem::transmute_copy(&found) }
}

/// Returns the result of a call that is not a submission, if the device is lost.
fn lost() -> Option<vk::Result> {
    state().is_lost.then_some(vk::Result::ERROR_DEVICE_LOST)
}

/// Waits forever if some work is never done.
fn hang(for_all: bool) {
    let state = state();
    if for_all && matches!(state.fault, Fault::Hang(first) if state.submissions >= first) {
        drop(state);
        std::thread::sleep(Duration::MAX);
    }
}

unsafe extern "system" fn queue_submit(
    queue: vk::Queue,
    count: u32,
    infos: *const vk::SubmitInfo<'_>,
    fence: vk::Fence,
) -> vk::Result {
    let (fault, number) = {
        let mut state = state();
        state.submissions += 1;
        (state.fault, state.submissions)
    };
    match fault {
        Fault::LostSubmit(first) | Fault::LostWait(first) if number >= first => {
            if number == first {
                // The work of a lost device is over, so that its resources may be destroyed.
                let _ = unsafe { next::<vk::PFN_vkQueueWaitIdle>(c"vkQueueWaitIdle")(queue) };
            }
            state().is_lost = true;
            match fault {
                Fault::LostWait(first) if number == first => vk::Result::SUCCESS,
                _ => vk::Result::ERROR_DEVICE_LOST,
            }
        }
        Fault::Hang(first) if number >= first => vk::Result::SUCCESS,
        _ => unsafe { next::<vk::PFN_vkQueueSubmit>(c"vkQueueSubmit")(queue, count, infos, fence) },
    }
}

unsafe extern "system" fn allocate_memory(
    device: vk::Device,
    info: *const vk::MemoryAllocateInfo<'_>,
    callbacks: *const vk::AllocationCallbacks<'_>,
    memory: *mut vk::DeviceMemory,
) -> vk::Result {
    let bytes = unsafe { (*info).allocation_size };
    let (fault, sum) = {
        let state = state();
        (state.fault, state.allocated.iter().flatten().map(|(_, bytes)| bytes).sum::<u64>())
    };
    if matches!(fault, Fault::Memory(most) if sum + bytes > most) {
        return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
    }
    let allocate = unsafe { next::<vk::PFN_vkAllocateMemory>(c"vkAllocateMemory") };
    let result = unsafe { allocate(device, info, callbacks, memory) };
    if result == vk::Result::SUCCESS {
        let handle = unsafe { *memory }.as_raw();
        state().allocated.get_or_insert_default().insert(handle, bytes);
    }
    result
}

unsafe extern "system" fn free_memory(
    device: vk::Device,
    memory: vk::DeviceMemory,
    callbacks: *const vk::AllocationCallbacks<'_>,
) {
    state().allocated.get_or_insert_default().remove(&memory.as_raw());
    unsafe { next::<vk::PFN_vkFreeMemory>(c"vkFreeMemory")(device, memory, callbacks) }
}

/// Functions that query the state of work, or wait for it.
macro_rules! asking {
    ($($function:ident: $type:ident, $name:literal, $for_all:literal, ($($argument:ident: $kind:ty),*);)*) => {$(
        unsafe extern "system" fn $function($($argument: $kind),*) -> vk::Result {
            hang($for_all);
            match lost() {
                Some(result) => result,
                None => unsafe { next::<vk::$type>($name)($($argument),*) },
            }
        }
    )*};
}

asking! {
    wait_semaphores: PFN_vkWaitSemaphores, c"vkWaitSemaphores", false,
        (device: vk::Device, info: *const vk::SemaphoreWaitInfo<'_>, timeout: u64);
    counter_value: PFN_vkGetSemaphoreCounterValue, c"vkGetSemaphoreCounterValue", false,
        (device: vk::Device, semaphore: vk::Semaphore, value: *mut u64);
    wait_fences: PFN_vkWaitForFences, c"vkWaitForFences", false,
        (device: vk::Device, count: u32, fences: *const vk::Fence, all: vk::Bool32, timeout: u64);
    fence_status: PFN_vkGetFenceStatus, c"vkGetFenceStatus", false, (device: vk::Device, fence: vk::Fence);
    queue_wait_idle: PFN_vkQueueWaitIdle, c"vkQueueWaitIdle", true, (queue: vk::Queue);
    device_wait_idle: PFN_vkDeviceWaitIdle, c"vkDeviceWaitIdle", true, (device: vk::Device);
}

/// Structures of the loader through which a layer finds the next one below (`vulkan/vk_layer.h`).
#[repr(C)]
struct Link<T> {
    kind: vk::StructureType,
    next: *const c_void,
    /// 0 for a link.
    function: i32,
    layer: *mut Layer<T>,
}

#[repr(C)]
struct Layer<T> {
    next: *mut Self,
    of_instance: vk::PFN_vkGetInstanceProcAddr,
    /// The function that finds a device's functions, in the link for a device.
    other: T,
}

/// Finds the link in a chain of structures, and removes this layer from it.
unsafe fn take_link<T: Copy>(
    mut chain: *const c_void,
    kind: vk::StructureType,
) -> Option<(vk::PFN_vkGetInstanceProcAddr, T)> {
    while !chain.is_null() {
        let link = unsafe { &mut *chain.cast::<Link<T>>().cast_mut() };
        if link.kind == kind && link.function == 0 {
            let layer = unsafe { &*link.layer };
            link.layer = layer.next;
            return Some((layer.of_instance, layer.other));
        }
        chain = link.next;
    }
    None
}

unsafe extern "system" fn create_instance(
    info: *const vk::InstanceCreateInfo<'_>,
    callbacks: *const vk::AllocationCallbacks<'_>,
    instance: *mut vk::Instance,
) -> vk::Result {
    let kind = vk::StructureType::LOADER_INSTANCE_CREATE_INFO;
    let link = unsafe { take_link::<*const c_void>((*info).p_next, kind) };
    let (Some((find, _)), Some(fault)) = (link, Fault::from_environment()) else {
        return vk::Result::ERROR_INITIALIZATION_FAILED;
    };
    let Some(create) = (unsafe { find(vk::Instance::null(), c"vkCreateInstance".as_ptr()) }) else {
        return vk::Result::ERROR_INITIALIZATION_FAILED;
    };
    let create: vk::PFN_vkCreateInstance = unsafe { transmute(create) };
    let result = unsafe { create(info, callbacks, instance) };
    if result == vk::Result::SUCCESS {
        let mut state = state();
        (state.fault, state.next_of_instance) = (fault, Some((find, unsafe { *instance })));
    }
    result
}

unsafe extern "system" fn create_device(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo<'_>,
    callbacks: *const vk::AllocationCallbacks<'_>,
    device: *mut vk::Device,
) -> vk::Result {
    let kind = vk::StructureType::LOADER_DEVICE_CREATE_INFO;
    let link = unsafe { take_link::<vk::PFN_vkGetDeviceProcAddr>((*info).p_next, kind) };
    let instance = state().next_of_instance;
    let (Some((find, find_of_device)), Some((_, instance))) = (link, instance) else {
        return vk::Result::ERROR_INITIALIZATION_FAILED;
    };
    let Some(create) = (unsafe { find(instance, c"vkCreateDevice".as_ptr()) }) else {
        return vk::Result::ERROR_INITIALIZATION_FAILED;
    };
    let create: vk::PFN_vkCreateDevice = unsafe { transmute(create) };
    let result = unsafe { create(physical, info, callbacks, device) };
    if result == vk::Result::SUCCESS {
        state().next_of_device = Some((find_of_device, unsafe { *device }));
    }
    result
}

/// Returns the layer's own function of a name.
unsafe fn own(name: *const c_char) -> vk::PFN_vkVoidFunction {
    let pointer = match unsafe { CStr::from_ptr(name) }.to_bytes() {
        b"vkGetInstanceProcAddr" => get_instance_proc_addr as *const c_void,
        b"vkGetDeviceProcAddr" => get_device_proc_addr as *const c_void,
        b"vkCreateInstance" => create_instance as *const c_void,
        b"vkCreateDevice" => create_device as *const c_void,
        b"vkQueueSubmit" => queue_submit as *const c_void,
        b"vkAllocateMemory" => allocate_memory as *const c_void,
        b"vkFreeMemory" => free_memory as *const c_void,
        b"vkWaitSemaphores" | b"vkWaitSemaphoresKHR" => wait_semaphores as *const c_void,
        b"vkGetSemaphoreCounterValue" | b"vkGetSemaphoreCounterValueKHR" => counter_value as *const c_void,
        b"vkWaitForFences" => wait_fences as *const c_void,
        b"vkGetFenceStatus" => fence_status as *const c_void,
        b"vkQueueWaitIdle" => queue_wait_idle as *const c_void,
        b"vkDeviceWaitIdle" => device_wait_idle as *const c_void,
        _ => return None,
    };
    unsafe { transmute(pointer) }
}

unsafe extern "system" fn get_instance_proc_addr(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let next = state().next_of_instance;
    unsafe { own(name).or_else(|| next.and_then(|(find, _)| find(instance, name))) }
}

unsafe extern "system" fn get_device_proc_addr(device: vk::Device, name: *const c_char) -> vk::PFN_vkVoidFunction {
    let next = state().next_of_device;
    unsafe { own(name).or_else(|| next.and_then(|(find, _)| find(device, name))) }
}

/// The structure in which the loader and a layer agree on a version.
#[repr(C)]
#[derive(Debug)]
pub struct Negotiation {
    kind: i32,
    next: *const c_void,
    version: u32,
    of_instance: Option<vk::PFN_vkGetInstanceProcAddr>,
    of_device: Option<vk::PFN_vkGetDeviceProcAddr>,
    of_physical_device: *const c_void,
}

/// The first function that the loader calls.
///
/// # Safety
/// The pointer must be that of the loader to its structure.
#[unsafe(no_mangle)]
pub unsafe extern "system" fn vkNegotiateLoaderLayerInterfaceVersion(negotiation: *mut Negotiation) -> vk::Result {
    let negotiation = unsafe { &mut *negotiation };
    negotiation.version = 2;
    negotiation.of_instance = Some(get_instance_proc_addr);
    negotiation.of_device = Some(get_device_proc_addr);
    negotiation.of_physical_device = std::ptr::null();
    vk::Result::SUCCESS
}
