# cmake --install: PREFIX/bin/clearway leads to the programs in PREFIX/lib/clearway, which find their files in
# PREFIX/share/clearway. Components: clearway, train (the trainer), python (the package, for `clearway python` and for parts).
set(data share/clearway)
install(TARGETS clearway clearway-run DESTINATION lib/clearway COMPONENT clearway)
if(TARGET clearway-train)
    install(TARGETS clearway-train DESTINATION lib/clearway COMPONENT train)
endif()
install(DIRECTORY scenarios models DESTINATION ${data} COMPONENT clearway)
install(DIRECTORY studies DESTINATION ${data} COMPONENT clearway FILES_MATCHING PATTERN *.toml PATTERN studies/streets/*/ EXCLUDE
        PATTERN studies/navigate/*/ EXCLUDE)
install(DIRECTORY python/clearway DESTINATION ${data}/python COMPONENT python FILES_MATCHING PATTERN *.py PATTERN *.jsonl
        PATTERN py.typed PATTERN __pycache__ EXCLUDE)
install(FILES python/install.py python/pyproject.toml DESTINATION ${data}/python COMPONENT python)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/install_help.cmake @ONLY CONTENT [[
set(prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
file(MAKE_DIRECTORY "${prefix}/bin")
file(CREATE_LINK ../lib/clearway/clearway "${prefix}/bin/clearway" SYMBOLIC)
execute_process(COMMAND "@CMAKE_SOURCE_DIR@/scripts/render-help" "@CMAKE_BINARY_DIR@/bin/clearway" "${prefix}/share"
                COMMAND_ERROR_IS_FATAL ANY)
]])
install(SCRIPT ${CMAKE_BINARY_DIR}/install_help.cmake COMPONENT clearway)
