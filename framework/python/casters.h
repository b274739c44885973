// Vectors, quaternions and other types of the facade as Python knows them.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>

#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace nanobind::detail {

template <glm::length_t N, class T>
struct type_caster<glm::vec<N, T, glm::defaultp>> {
  using Vector = glm::vec<N, T, glm::defaultp>;
  using Array = make_caster<std::array<T, size_t(N)>>;
  NB_TYPE_CASTER(Vector, Array::Name)

  bool from_python(handle source, uint8_t flags, cleanup_list* cleanup) noexcept {
    Array array;
    if (!array.from_python(source, flags, cleanup)) return false;
    for (glm::length_t i = 0; i < N; ++i) value[i] = array.value[size_t(i)];
    return true;
  }
  static handle from_cpp(const Vector& vector, rv_policy policy, cleanup_list* cleanup) noexcept {
    std::array<T, size_t(N)> array;
    for (glm::length_t i = 0; i < N; ++i) array[size_t(i)] = vector[i];
    return Array::from_cpp(array, policy, cleanup);
  }
};

// x, y, z, w, as in glTF.
template <>
struct type_caster<glm::quat> {
  using Array = make_caster<glm::vec4>;
  NB_TYPE_CASTER(glm::quat, Array::Name)

  bool from_python(handle source, uint8_t flags, cleanup_list* cleanup) noexcept {
    Array array;
    if (!array.from_python(source, flags, cleanup)) return false;
    const glm::vec4& v = array.value;
    value = glm::quat(v.w, v.x, v.y, v.z);
    return true;
  }
  static handle from_cpp(const glm::quat& q, rv_policy policy, cleanup_list* cleanup) noexcept {
    return Array::from_cpp(glm::vec4(q.x, q.y, q.z, q.w), policy, cleanup);
  }
};

}  // namespace nanobind::detail
