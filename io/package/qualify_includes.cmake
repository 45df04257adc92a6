# Makes the installed headers include each other as "svdag/io/..." instead of "io/...".
file(GLOB_RECURSE headers ${include_folder}/*.h)
foreach(header ${headers})
  file(READ ${header} text)
  string(REGEX REPLACE "#include \"(io|streaming|verify)/" "#include \"svdag/\\1/" qualified "${text}")
  if(NOT qualified STREQUAL text)
    file(WRITE ${header} "${qualified}")
  endif()
endforeach()
