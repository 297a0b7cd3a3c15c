#pragma once

#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/errors.h"

namespace mimik::cli {

/// What --json prints of an error: schema, error, and what the message names: file, line, option (null: nothing).
[[nodiscard]] std::string error_json(const std::string& message, int exit_code, const std::vector<std::string>& words);

/// Whether --json stands among the words of a command line.
[[nodiscard]] bool asks_for_json(const std::vector<std::string>& words);

/// Who gives a workspace where a database belongs is told so. @throws InputError
void refuse_workspace(const std::filesystem::path& database);

/// "file: message" with the first of the files, unless the message has one of them.
[[nodiscard]] std::string with_file(const std::vector<std::filesystem::path>& files, std::string_view message);

[[nodiscard]] std::string no_memory_for(const std::vector<std::filesystem::path>& files);

/// What `work` gives; whatever it throws names one of the files, the first where it names none itself.
template <class Work>
auto naming_any(const std::vector<std::filesystem::path>& files, const Work& work) {
    try {
        return work();
    } catch (const InputError& e) {
        throw InputError(with_file(files, e.what()));
    } catch (const NumericalError& e) {
        throw NumericalError(with_file(files, e.what()));
    } catch (const std::system_error& e) {  // no thread, no disk
        throw InputError(with_file(files, e.what()));
    } catch (const std::bad_alloc&) {
        throw InputError(no_memory_for(files));
    } catch (const std::length_error&) {
        throw InputError(no_memory_for(files));
    }
}
template <class Work>
auto naming(const std::filesystem::path& file, const Work& work) {
    return naming_any({file}, work);
}

}  // namespace mimik::cli
