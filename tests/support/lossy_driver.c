/* A Vulkan driver that loses its device. It hands everything on to the driver that LOSSY_DRIVER
 * names, but the calls of the function LOSSY_CALL, counted over all devices, report from number
 * LOSSY_FIRST on LOSSY_TIMES times that the device is lost. A lost device stays lost: until the
 * next one is made, everything that may report a loss does. With LOSSY_GONE there is no next one:
 * whoever asks for devices after a loss finds none. */

#include <dlfcn.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define DEVICE_LOST (-4)

typedef int Result;
typedef void (*Function)(void);
typedef Function (*GetFunction)(void *parent, const char *name);

static long calls;
static int lost;

static Function symbol(const char *name) {
    static void *driver;
    Function found = NULL;
    if (!driver) driver = dlopen(getenv("LOSSY_DRIVER"), RTLD_NOW | RTLD_LOCAL);
    if (!driver) abort();
    *(void **)&found = dlsym(driver, name);
    return found;
}

/* Whether the device is lost, now that `name` is called. */
static int is_lost(const char *name) {
    if (!lost && strcmp(name, getenv("LOSSY_CALL")) == 0) {
        long after = ++calls - atol(getenv("LOSSY_FIRST"));
        lost = after >= 0 && after < atol(getenv("LOSSY_TIMES"));
    }
    return lost;
}

/* What is lost before it reaches the driver. */
static Result (*real_submit)(void *, uint32_t, const void *, uint64_t);
static Result submit(void *queue, uint32_t count, const void *submits, uint64_t fence) {
    return is_lost("vkQueueSubmit") ? DEVICE_LOST : real_submit(queue, count, submits, fence);
}

/* The waits are waited for all the same, as what runs may use memory that is freed next. */
static Result (*real_wait)(void *, const void *, uint64_t);
static Result wait(void *device, const void *info, uint64_t timeout) {
    Result result = real_wait(device, info, timeout);
    return is_lost("vkWaitSemaphores") ? DEVICE_LOST : result;
}

static Result (*real_queue_idle)(void *);
static Result queue_idle(void *queue) {
    Result result = real_queue_idle(queue);
    return lost ? DEVICE_LOST : result;
}

static Result (*real_counter)(void *, uint64_t, uint64_t *);
static Result counter(void *device, uint64_t semaphore, uint64_t *value) {
    return lost ? DEVICE_LOST : real_counter(device, semaphore, value);
}

static Result (*real_create)(void *, const void *, const void *, void **);
static Result create(void *physical, const void *info, const void *allocator, void **device) {
    lost = 0;
    return real_create(physical, info, allocator, device);
}

static Result (*real_enumerate)(void *, uint32_t *, void **);
static Result enumerate(void *instance, uint32_t *count, void **devices) {
    if (!lost || !getenv("LOSSY_GONE")) return real_enumerate(instance, count, devices);
    *count = 0;
    return 0;
}

static Function instead(const char *name, Function real);

static GetFunction real_device_function;
static Function device_function(void *device, const char *name) {
    return instead(name, real_device_function(device, name));
}

/* What is called instead of a function of the driver. */
static Function instead(const char *name, Function real) {
#define REPLACE(vulkan, ours) \
    if (real && strcmp(name, vulkan) == 0) { \
        *(Function *)&real_##ours = real; \
        return (Function)ours; \
    }
    REPLACE("vkGetDeviceProcAddr", device_function)
    REPLACE("vkEnumeratePhysicalDevices", enumerate)
    REPLACE("vkCreateDevice", create)
    REPLACE("vkQueueSubmit", submit)
    REPLACE("vkQueueWaitIdle", queue_idle)
    REPLACE("vkWaitSemaphores", wait)
    REPLACE("vkWaitSemaphoresKHR", wait)
    REPLACE("vkGetSemaphoreCounterValue", counter)
    REPLACE("vkGetSemaphoreCounterValueKHR", counter)
    return real;
}

Function vk_icdGetInstanceProcAddr(void *instance, const char *name) {
    return instead(name, ((GetFunction)symbol("vk_icdGetInstanceProcAddr"))(instance, name));
}

Function vk_icdGetPhysicalDeviceProcAddr(void *instance, const char *name) {
    return ((GetFunction)symbol("vk_icdGetPhysicalDeviceProcAddr"))(instance, name);
}

Result vk_icdNegotiateLoaderICDInterfaceVersion(uint32_t *version) {
    return ((Result (*)(uint32_t *))symbol("vk_icdNegotiateLoaderICDInterfaceVersion"))(version);
}
