# Run at build: writes OUTPUT, a C++ file that holds each of FILES (folder FOLDER) as a string, in a table by name.
set(entries "")
foreach(file ${FILES})
  file(READ ${FOLDER}/${file} text)
  string(APPEND entries "    {\"${file}\", R\"kernel(${text})kernel\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"particles/opencl/kernel_text.hpp\"\n\nnamespace weir::particles {\n\nconst std::vector<KernelText>& kernel_texts() {\n"
  "  static const std::vector<KernelText> texts = {\n${entries}  };\n  return texts;\n}\n\n}  // namespace weir::particles\n")
