#pragma once

#include <boost/system/result.hpp>
#include <string>
#include <utility>

#include "server/base/error.hpp"

namespace tweend {

/// A value, or why there is none. Test it, then use `*result` or `result.error()`;
/// `.value()` is not used: no exception crosses a layer.
template <class T>
using Result = boost::system::result<T, Error>;

/// Success, or why not.
using Status = Result<void>;

/// Shorthand for returning an error: `return fail(ErrorCode::NotFound, "…", "params.actor");`
[[nodiscard]] inline Error fail(ErrorCode code, std::string message, std::string path = {}) {
  return Error{code, std::move(message), std::move(path), {}};
}

}  // namespace tweend

/// Leaves the function with the error of `expression` (a Status or Result), if it has one.
#define TWEEND_TRY(expression)                                                           \
  do {                                                                                   \
    if (auto tweend_status = (expression); !tweend_status) return tweend_status.error(); \
  } while (false)

/// Declares `declaration` with the value of `expression`, or leaves the function with its error.
#define TWEEND_ASSIGN(declaration, expression) TWEEND_ASSIGN_(TWEEND_CONCAT_(tweend_result_, __LINE__), declaration, expression)
#define TWEEND_ASSIGN_(result, declaration, expression) \
  auto result = (expression);                           \
  if (!result) return result.error();                   \
  declaration = std::move(*result)
#define TWEEND_CONCAT_(a, b) TWEEND_CONCAT2_(a, b)
#define TWEEND_CONCAT2_(a, b) a##b
