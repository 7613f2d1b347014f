// Blum: functions that are handed on and called, but not kept. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace blum {

template <class Signature>
class FunctionRef;

/// Refers to something callable for the time of a call; it never allocates. What it refers to must outlive it.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  // The object is not forwarded but referred to, and call_ gives it its own type back. A lambda is passed as it is.
  // NOLINTBEGIN(google-explicit-constructor,cppcoreguidelines-missing-std-forward,cppcoreguidelines-pro-type-const-cast)
  template <class Callable>
    requires(!std::is_same_v<std::remove_cvref_t<Callable>, FunctionRef> &&
             std::is_invocable_r_v<Result, Callable&, Arguments...>)
  FunctionRef(Callable&& callable)
      : object_(const_cast<void*>(static_cast<const void*>(std::addressof(callable)))),
        call_([](void* object, Arguments... arguments) -> Result {
          return (*static_cast<std::add_pointer_t<Callable>>(object))(std::forward<Arguments>(arguments)...);
        }) {}
  // NOLINTEND(google-explicit-constructor,cppcoreguidelines-missing-std-forward,cppcoreguidelines-pro-type-const-cast)

  Result operator()(Arguments... arguments) const { return call_(object_, std::forward<Arguments>(arguments)...); }

 private:
  void* object_;
  Result (*call_)(void*, Arguments...);
};

}  // namespace blum
