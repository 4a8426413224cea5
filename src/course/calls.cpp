#include "course/calls.h"

namespace etendue {

thread_local std::vector<Call>* CallRecording::current_ = nullptr;

}  // namespace etendue
