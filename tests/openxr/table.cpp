// The table of functions through which the loader reaches the runtime.
#include "tests/openxr/runtime.h"

namespace fovea::test {

XrResult enumerateInstanceExtensionProperties(const char*, uint32_t capacity, uint32_t* count,
                                              XrExtensionProperties* properties);
XrResult createInstance(const XrInstanceCreateInfo* info, XrInstance* instance);
XrResult destroyInstance(XrInstance);
XrResult getInstanceProperties(XrInstance, XrInstanceProperties* properties);
XrResult pollEvent(XrInstance, XrEventDataBuffer* event);
XrResult resultToString(XrInstance, XrResult value, char text[XR_MAX_RESULT_STRING_SIZE]);
XrResult structureTypeToString(XrInstance, XrStructureType value, char text[XR_MAX_STRUCTURE_NAME_SIZE]);
XrResult stringToPath(XrInstance, const char* text, XrPath* path);
XrResult pathToString(XrInstance, XrPath path, uint32_t capacity, uint32_t* count, char* text);
XrResult convertTimespecTimeToTime(XrInstance, const timespec*, XrTime* time);
XrResult getSystem(XrInstance, const XrSystemGetInfo* info, XrSystemId* system);
XrResult getSystemProperties(XrInstance, XrSystemId system, XrSystemProperties* properties);
XrResult enumerateEnvironmentBlendModes(XrInstance, XrSystemId, XrViewConfigurationType, uint32_t capacity,
                                        uint32_t* count, XrEnvironmentBlendMode* modes);
XrResult enumerateViewConfigurations(XrInstance, XrSystemId, uint32_t capacity, uint32_t* count,
                                     XrViewConfigurationType* types);
XrResult getViewConfigurationProperties(XrInstance, XrSystemId, XrViewConfigurationType type,
                                        XrViewConfigurationProperties* properties);
XrResult enumerateViewConfigurationViews(XrInstance, XrSystemId, XrViewConfigurationType type,
                                         uint32_t capacity, uint32_t* count, XrViewConfigurationView* views);
XrResult getVulkanGraphicsRequirements2(XrInstance, XrSystemId, XrGraphicsRequirementsVulkan2KHR* needs);
XrResult createVulkanInstance(XrInstance, const XrVulkanInstanceCreateInfoKHR* info, VkInstance* instance,
                              VkResult* result);
XrResult getVulkanGraphicsDevice2(XrInstance, const XrVulkanGraphicsDeviceGetInfoKHR* info,
                                  VkPhysicalDevice* device);
XrResult createVulkanDevice(XrInstance, const XrVulkanDeviceCreateInfoKHR* info, VkDevice* device,
                            VkResult* result);
XrResult createSession(XrInstance, const XrSessionCreateInfo* info, XrSession* session);
XrResult destroySession(XrSession);
XrResult beginSession(XrSession, const XrSessionBeginInfo* info);
XrResult endSession(XrSession);
XrResult requestExitSession(XrSession);
XrResult waitFrame(XrSession, const XrFrameWaitInfo*, XrFrameState* state);
XrResult beginFrame(XrSession, const XrFrameBeginInfo*);
XrResult endFrame(XrSession, const XrFrameEndInfo* info);
XrResult enumerateReferenceSpaces(XrSession, uint32_t capacity, uint32_t* count, XrReferenceSpaceType* types);
XrResult createReferenceSpace(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* space);
XrResult createActionSpace(XrSession, const XrActionSpaceCreateInfo* info, XrSpace* space);
XrResult destroySpace(XrSpace space);
XrResult locateSpace(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* location);
XrResult locateViews(XrSession, const XrViewLocateInfo* info, XrViewState* state, uint32_t capacity,
                     uint32_t* count, XrView* views);
XrResult createActionSet(XrInstance, const XrActionSetCreateInfo*, XrActionSet* set);
XrResult destroyActionSet(XrActionSet);
XrResult createAction(XrActionSet, const XrActionCreateInfo* info, XrAction* action);
XrResult suggestInteractionProfileBindings(XrInstance, const XrInteractionProfileSuggestedBinding* info);
XrResult attachSessionActionSets(XrSession, const XrSessionActionSetsAttachInfo*);
XrResult syncActions(XrSession, const XrActionsSyncInfo*);
XrResult getActionStateVector2f(XrSession, const XrActionStateGetInfo* info, XrActionStateVector2f* state);
XrResult getActionStatePose(XrSession, const XrActionStateGetInfo* info, XrActionStatePose* state);
XrResult enumerateSwapchainFormats(XrSession, uint32_t capacity, uint32_t* count, int64_t* formats);
XrResult createSwapchain(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* swapchain);
XrResult destroySwapchain(XrSwapchain swapchain);
XrResult enumerateSwapchainImages(XrSwapchain swapchain, uint32_t capacity, uint32_t* count,
                                  XrSwapchainImageBaseHeader* images);
XrResult acquireSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageAcquireInfo*, uint32_t* index);
XrResult waitSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageWaitInfo*);
XrResult releaseSwapchainImage(XrSwapchain swapchain, const XrSwapchainImageReleaseInfo*);

namespace {

XrResult getInstanceProcAddr(XrInstance, const char* name, PFN_xrVoidFunction* function) {
  *function = functionNamed(name);
  return *function ? XR_SUCCESS : XR_ERROR_FUNCTION_UNSUPPORTED;
}

}  // namespace

PFN_xrVoidFunction functionNamed(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> functions = {
      {"xrGetInstanceProcAddr", reinterpret_cast<PFN_xrVoidFunction>(getInstanceProcAddr)},
      {"xrEnumerateInstanceExtensionProperties",
       reinterpret_cast<PFN_xrVoidFunction>(enumerateInstanceExtensionProperties)},
      {"xrCreateInstance", reinterpret_cast<PFN_xrVoidFunction>(createInstance)},
      {"xrDestroyInstance", reinterpret_cast<PFN_xrVoidFunction>(destroyInstance)},
      {"xrGetInstanceProperties", reinterpret_cast<PFN_xrVoidFunction>(getInstanceProperties)},
      {"xrPollEvent", reinterpret_cast<PFN_xrVoidFunction>(pollEvent)},
      {"xrResultToString", reinterpret_cast<PFN_xrVoidFunction>(resultToString)},
      {"xrStructureTypeToString", reinterpret_cast<PFN_xrVoidFunction>(structureTypeToString)},
      {"xrStringToPath", reinterpret_cast<PFN_xrVoidFunction>(stringToPath)},
      {"xrPathToString", reinterpret_cast<PFN_xrVoidFunction>(pathToString)},
      {"xrConvertTimespecTimeToTimeKHR", reinterpret_cast<PFN_xrVoidFunction>(convertTimespecTimeToTime)},
      {"xrGetSystem", reinterpret_cast<PFN_xrVoidFunction>(getSystem)},
      {"xrGetSystemProperties", reinterpret_cast<PFN_xrVoidFunction>(getSystemProperties)},
      {"xrEnumerateEnvironmentBlendModes",
       reinterpret_cast<PFN_xrVoidFunction>(enumerateEnvironmentBlendModes)},
      {"xrEnumerateViewConfigurations", reinterpret_cast<PFN_xrVoidFunction>(enumerateViewConfigurations)},
      {"xrGetViewConfigurationProperties",
       reinterpret_cast<PFN_xrVoidFunction>(getViewConfigurationProperties)},
      {"xrEnumerateViewConfigurationViews",
       reinterpret_cast<PFN_xrVoidFunction>(enumerateViewConfigurationViews)},
      {"xrGetVulkanGraphicsRequirements2KHR",
       reinterpret_cast<PFN_xrVoidFunction>(getVulkanGraphicsRequirements2)},
      {"xrCreateVulkanInstanceKHR", reinterpret_cast<PFN_xrVoidFunction>(createVulkanInstance)},
      {"xrGetVulkanGraphicsDevice2KHR", reinterpret_cast<PFN_xrVoidFunction>(getVulkanGraphicsDevice2)},
      {"xrCreateVulkanDeviceKHR", reinterpret_cast<PFN_xrVoidFunction>(createVulkanDevice)},
      {"xrCreateSession", reinterpret_cast<PFN_xrVoidFunction>(createSession)},
      {"xrDestroySession", reinterpret_cast<PFN_xrVoidFunction>(destroySession)},
      {"xrBeginSession", reinterpret_cast<PFN_xrVoidFunction>(beginSession)},
      {"xrEndSession", reinterpret_cast<PFN_xrVoidFunction>(endSession)},
      {"xrRequestExitSession", reinterpret_cast<PFN_xrVoidFunction>(requestExitSession)},
      {"xrWaitFrame", reinterpret_cast<PFN_xrVoidFunction>(waitFrame)},
      {"xrBeginFrame", reinterpret_cast<PFN_xrVoidFunction>(beginFrame)},
      {"xrEndFrame", reinterpret_cast<PFN_xrVoidFunction>(endFrame)},
      {"xrEnumerateReferenceSpaces", reinterpret_cast<PFN_xrVoidFunction>(enumerateReferenceSpaces)},
      {"xrCreateReferenceSpace", reinterpret_cast<PFN_xrVoidFunction>(createReferenceSpace)},
      {"xrCreateActionSpace", reinterpret_cast<PFN_xrVoidFunction>(createActionSpace)},
      {"xrDestroySpace", reinterpret_cast<PFN_xrVoidFunction>(destroySpace)},
      {"xrLocateSpace", reinterpret_cast<PFN_xrVoidFunction>(locateSpace)},
      {"xrLocateViews", reinterpret_cast<PFN_xrVoidFunction>(locateViews)},
      {"xrCreateActionSet", reinterpret_cast<PFN_xrVoidFunction>(createActionSet)},
      {"xrDestroyActionSet", reinterpret_cast<PFN_xrVoidFunction>(destroyActionSet)},
      {"xrCreateAction", reinterpret_cast<PFN_xrVoidFunction>(createAction)},
      {"xrSuggestInteractionProfileBindings",
       reinterpret_cast<PFN_xrVoidFunction>(suggestInteractionProfileBindings)},
      {"xrAttachSessionActionSets", reinterpret_cast<PFN_xrVoidFunction>(attachSessionActionSets)},
      {"xrSyncActions", reinterpret_cast<PFN_xrVoidFunction>(syncActions)},
      {"xrGetActionStateVector2f", reinterpret_cast<PFN_xrVoidFunction>(getActionStateVector2f)},
      {"xrGetActionStatePose", reinterpret_cast<PFN_xrVoidFunction>(getActionStatePose)},
      {"xrEnumerateSwapchainFormats", reinterpret_cast<PFN_xrVoidFunction>(enumerateSwapchainFormats)},
      {"xrCreateSwapchain", reinterpret_cast<PFN_xrVoidFunction>(createSwapchain)},
      {"xrDestroySwapchain", reinterpret_cast<PFN_xrVoidFunction>(destroySwapchain)},
      {"xrEnumerateSwapchainImages", reinterpret_cast<PFN_xrVoidFunction>(enumerateSwapchainImages)},
      {"xrAcquireSwapchainImage", reinterpret_cast<PFN_xrVoidFunction>(acquireSwapchainImage)},
      {"xrWaitSwapchainImage", reinterpret_cast<PFN_xrVoidFunction>(waitSwapchainImage)},
      {"xrReleaseSwapchainImage", reinterpret_cast<PFN_xrVoidFunction>(releaseSwapchainImage)},
  };
  const auto found = functions.find(name);
  return found == functions.end() ? nullptr : found->second;
}

}  // namespace fovea::test

// What the loader and a runtime tell each other (openxr_loader_negotiation.h, which Debian does not have).
struct XrNegotiateLoaderInfo {
  uint32_t structType, structVersion;
  size_t structSize;
  uint32_t minInterfaceVersion, maxInterfaceVersion;
  XrVersion minApiVersion, maxApiVersion;
};
struct XrNegotiateRuntimeRequest {
  uint32_t structType, structVersion;
  size_t structSize;
  uint32_t runtimeInterfaceVersion;
  XrVersion runtimeApiVersion;
  PFN_xrGetInstanceProcAddr getInstanceProcAddr;
};

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const XrNegotiateLoaderInfo*, XrNegotiateRuntimeRequest* request) {
  request->runtimeInterfaceVersion = 1;
  request->runtimeApiVersion = XR_CURRENT_API_VERSION;
  request->getInstanceProcAddr = fovea::test::getInstanceProcAddr;
  return XR_SUCCESS;
}
