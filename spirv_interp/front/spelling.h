// Names of the grammar for messages, by way of the disassembler, which knows them all.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "spirv_interp/front/module.h"

namespace vernier {

/// The last operand of an instruction made of these operand words, as the disassembler writes it; the number if it
/// cannot.
std::string lastOperandOf(spv::Op op, std::initializer_list<uint32_t> operands);

std::string nameOf(spv::Capability capability);
std::string nameOf(spv::BuiltIn builtin);
std::string nameOf(spv::StorageClass storage);
std::string nameOf(spv::Decoration decoration);
/// The mode of an OpExecutionMode or OpExecutionModeId, without its operands.
std::string executionModeOf(const Instruction& inst);

}  // namespace vernier
