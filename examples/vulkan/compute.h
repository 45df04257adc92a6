// Runs a compute shader on the first Vulkan device, with storage buffers that the processor sees.
#pragma once

#include <fstream>
#include <iterator>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

class Compute {
 public:
  struct Buffer {
    vk::raii::DeviceMemory memory;
    vk::raii::Buffer buffer;
    void* data;  // stays mapped
  };

  std::string name() const { return gpu_.getProperties().deviceName; }

  // In the GPU's own memory if the processor sees it; else an engine copies through a staging buffer.
  Buffer storage(size_t bytes) const {
    vk::raii::Buffer buffer(device_, vk::BufferCreateInfo({}, bytes, vk::BufferUsageFlagBits::eStorageBuffer));
    const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
    using Flag = vk::MemoryPropertyFlagBits;
    const vk::MemoryPropertyFlags seen = Flag::eHostVisible | Flag::eHostCoherent;
    const auto types = gpu_.getMemoryProperties().memoryTypes;
    uint32_t type = 0;
    for (uint32_t i = 32, best = 0; i-- > 0;) {
      if (!(needs.memoryTypeBits >> i & 1) || (types[i].propertyFlags & seen) != seen) continue;
      const uint32_t value = types[i].propertyFlags & Flag::eDeviceLocal ? 2 : 1;
      if (value >= best) type = i, best = value;
    }
    vk::raii::DeviceMemory memory(device_, vk::MemoryAllocateInfo(needs.size, type));
    buffer.bindMemory(*memory, 0);
    void* const data = memory.mapMemory(0, bytes);
    return {std::move(memory), std::move(buffer), data};
  }

  // Binding 0 is the array `file`, of which absent buffers up to `count` are not read; binding 1 is `output`.
  void run(const std::string& path, const std::vector<Buffer>& file, uint32_t count, const Buffer& output,
           uint32_t x, uint32_t y) const {
    std::ifstream input(path, std::ios::binary);
    const std::string code(std::istreambuf_iterator<char>(input), {});
    if (code.empty()) throw std::runtime_error(path + ": cannot be read");
    const vk::raii::ShaderModule module(
        device_, vk::ShaderModuleCreateInfo({}, code.size(), reinterpret_cast<const uint32_t*>(code.data())));
    constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
    constexpr auto kCompute = vk::ShaderStageFlagBits::eCompute;
    const vk::DescriptorSetLayoutBinding bindings[] = {{0, kStorage, count, kCompute}, {1, kStorage, 1, kCompute}};
    const vk::raii::DescriptorSetLayout set_layout(device_, vk::DescriptorSetLayoutCreateInfo({}, bindings));
    const vk::raii::PipelineLayout layout(device_, vk::PipelineLayoutCreateInfo({}, *set_layout));
    const vk::PipelineShaderStageCreateInfo stage({}, kCompute, *module, "main");
    const vk::raii::Pipeline pipeline(device_, nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout));

    const vk::DescriptorPoolSize sizes(kStorage, count + 1);
    const auto free = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet;
    const vk::raii::DescriptorPool pool(device_, vk::DescriptorPoolCreateInfo(free, 1, sizes));
    const vk::raii::DescriptorSets sets(device_, vk::DescriptorSetAllocateInfo(*pool, *set_layout));
    for (uint32_t i = 0; i <= count; ++i) {
      const Buffer& bound = i == count ? output : file[i < file.size() ? i : 0];
      const vk::DescriptorBufferInfo info(*bound.buffer, 0, VK_WHOLE_SIZE);
      device_.updateDescriptorSets(vk::WriteDescriptorSet(*sets[0], i / count, i % count, kStorage, {}, info), {});
    }

    const vk::raii::CommandPool pool_of_commands(device_, vk::CommandPoolCreateInfo({}, family_));
    const vk::raii::CommandBuffers commands(
        device_, vk::CommandBufferAllocateInfo(*pool_of_commands, vk::CommandBufferLevel::ePrimary, 1));
    commands[0].begin(vk::CommandBufferBeginInfo());
    commands[0].bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
    commands[0].bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout, 0, *sets[0], {});
    commands[0].dispatch(x, y, 1);
    const vk::MemoryBarrier written(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eHostRead);
    using Stage = vk::PipelineStageFlagBits;
    commands[0].pipelineBarrier(Stage::eComputeShader, Stage::eHost, {}, written, {}, {});
    commands[0].end();
    const vk::raii::Queue queue = device_.getQueue(family_, 0);
    queue.submit(vk::SubmitInfo({}, {}, *commands[0]));
    queue.waitIdle();
  }

 private:
  static uint32_t compute_family(const vk::raii::PhysicalDevice& gpu) {
    const auto families = gpu.getQueueFamilyProperties();
    uint32_t i = 0;
    while (i + 1 < families.size() && !(families[i].queueFlags & vk::QueueFlagBits::eCompute)) ++i;
    return i;
  }

  vk::raii::Context context_;
  vk::ApplicationInfo application_{nullptr, 0, nullptr, 0, VK_API_VERSION_1_1};
  vk::raii::Instance instance_{context_, vk::InstanceCreateInfo({}, &application_)};
  vk::raii::PhysicalDevice gpu_{std::move(vk::raii::PhysicalDevices(instance_).front())};
  uint32_t family_ = compute_family(gpu_);
  float priority_ = 1;
  vk::DeviceQueueCreateInfo queue_{{}, family_, 1, &priority_};
  vk::raii::Device device_{gpu_, vk::DeviceCreateInfo({}, queue_)};
};
