# Run by CPack on the files of a package: Debian requires compressed man pages without a time stamp.
file(GLOB_RECURSE pages "${CPACK_TEMPORARY_DIRECTORY}/svdag*.[17]")
if(pages)
  execute_process(COMMAND gzip -9 -n -f ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()
