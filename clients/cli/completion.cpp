#include "clients/cli/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace tweend::cli {
namespace {

constexpr std::string_view kHead = R"BASH(# bash completion for tweenctl; load it by: source <(tweenctl completion bash)

)BASH";

// Words are read from COMP_LINE, because bash also splits COMP_WORDS at the ':' of ADDR:PORT and at '='.
constexpr std::string_view kTail = R"BASH(
# Prints what a value of the shape $1 may be. $2: the program, $3: the first argument, the rest: global options.
_tweenctl_candidates() {
  local shape=$1 program=$2 first=$3
  local -a ask=("$program" --timeout 1 "${@:4}")
  case $shape in
    ACTOR) "${ask[@]}" actors --names ;;
    ASSET) "${ask[@]}" assets --names ;;
    CLIP) "${ask[@]}" clips --names ;;
    SCENE) "${ask[@]}" scenes --names ;;
    METHOD) "${ask[@]}" methods --names ;;
    NAME=VALUE) "${ask[@]}" methods "$first" --names | sed 's/$/=/' ;;
    FILE) compgen -f -- "$cur" ;;
    *) printf '%s\n' "${shape//|/$'\n'}" | grep '^[a-z]' ;;
  esac 2>/dev/null
}

_tweenctl() {
  local program=${1/#\~/$HOME} line=${COMP_LINE:0:COMP_POINT} path='' pending='' REPLY='' cur word i
  local -a words=() globals=() arguments=()
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=('')
  cur=${words[-1]}
  for ((i = 1; i < ${#words[@]} - 1; ++i)); do
    word=${words[i]}
    if [[ $pending ]]; then
      [[ $pending == --server || $pending == --scene ]] && globals+=("$pending" "$word")
      pending=''
    elif [[ $word == --server=* || $word == --scene=* ]]; then
      globals+=("$word")
    elif [[ $word == -?* ]]; then
      _tweenctl_shape "$path" "$word" && pending=$word
    elif [[ ${#arguments[@]} -eq 0 ]] && _tweenctl_words "${path:+$path }$word"; then
      path="${path:+$path }$word"
    else
      arguments+=("$word")
    fi
  done

  local candidates='' shape=''
  if [[ $pending ]]; then
    _tweenctl_shape "$path" "$pending" && shape=$REPLY
  elif [[ $cur == --*=* ]]; then
    _tweenctl_shape "$path" "${cur%%=*}" && shape=$REPLY
    cur=${cur#*=}
  else
    _tweenctl_words "$path" && candidates=${REPLY// /$'\n'}
    [[ $cur != -* ]] && _tweenctl_shape "$path" "$((${#arguments[@]} + 1))" && shape=$REPLY
  fi
  [[ $shape ]] && candidates+=$'\n'$(_tweenctl_candidates "$shape" "$program" "${arguments[0]:-}" "${globals[@]}")

  [[ $shape == FILE ]] && compopt -o filenames 2>/dev/null  # bash then quotes them and adds the slash of a folder
  COMPREPLY=()
  while IFS= read -r word; do
    [[ $word && $word == "$cur"* && ($word != -* || $cur == -*) ]] || continue
    [[ $word == *= ]] && compopt -o nospace 2>/dev/null
    [[ $word == *= || $word == -* || $shape == FILE ]] || printf -v word '%q' "$word"
    COMPREPLY+=("$word")
  done <<<"$candidates"
}
complete -F _tweenctl tweenctl
)BASH";

bool has_option(const Outline& outline, std::string_view name) {
  return std::any_of(outline.options.begin(), outline.options.end(), [&](const auto& option) { return option.name == name; });
}

std::string words_case(const Outline& outline, const Outline& root) {
  std::string words;
  const auto add = [&](const std::string& word) { words += (words.empty() ? "" : " ") + word; };
  for (const auto& command : outline.commands) add(command);
  for (const auto& option : outline.options) add(option.name);
  if (&outline != &root) {
    for (const auto& option : root.options) {
      if (option.name.starts_with("--") && !has_option(outline, option.name)) add(option.name);
    }
  }
  return fmt::format("    '{}') REPLY='{}' ;;\n", outline.path, words);
}

std::string shape_cases(const Outline& outline, bool is_root) {
  std::string cases;
  const auto add = [&](std::string_view key, std::string_view shape) {
    if (shape.empty()) return;
    // The program's own options may also follow a command: these cases stand last and fit any.
    cases += fmt::format("    {}'{} {}') REPLY='{}' ;;\n", is_root ? "*" : "", outline.path, key, shape);
  };
  for (const auto& option : outline.options) add(option.name, option.shape);
  for (std::size_t i = 0; i < outline.arguments.size(); ++i) add(std::to_string(i + 1), outline.arguments[i].shape);
  if (!outline.arguments.empty() && outline.arguments.back().repeats) {
    cases += fmt::format("    '{} '[0-9]*) REPLY='{}' ;;\n", outline.path, outline.arguments.back().shape);
  }
  return cases;
}

}  // namespace

std::string bash_completion(const std::vector<Outline>& outlines) {
  const Outline& root = outlines.front();
  std::string script(kHead);
  script += "# What may follow the command $1: its commands and options. Fails where there is no such command.\n";
  script += "_tweenctl_words() {\n  case $1 in\n";
  for (const Outline& outline : outlines) script += words_case(outline, root);
  script += "    *) return 1 ;;\n  esac\n}\n\n";
  script += "# The shape of the value of option $2 of the command $1, or of its $2-th argument. Fails where it takes none.\n";
  script += "_tweenctl_shape() {\n  case \"$1 $2\" in\n";
  for (std::size_t i = 1; i < outlines.size(); ++i) script += shape_cases(outlines[i], false);
  script += shape_cases(root, true);
  script += "    *) return 1 ;;\n  esac\n}\n";
  script += kTail;
  return script;
}

}  // namespace tweend::cli
