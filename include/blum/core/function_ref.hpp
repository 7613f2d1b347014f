// Blum: references to functions, valid during a call. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace blum {

template <class Signature>
class FunctionRef;

/// Reference to a callable object, for the duration of a call. FunctionRef never allocates memory. The callable object
/// must outlive the reference.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  // The constructor stores the address of the object instead of forwarding it, and call_ restores its type. The
  // constructor is implicit, so that a lambda can be passed directly.
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
