# Modules: one folder = one target = one namespace. Each has an include root of its own in the build tree, which holds
# nothing but a link to its folder. A file sees the roots of the modules that its own module declares, and no others: what a
# declared module uses is linked, but not seen. So a module also declares what the headers that it includes need.
# `scripts/count-house` lists both kinds and finds those that nothing needs.

# Who may see the truth and the sensors. All others decide, report or schedule, and must not be able to.
set(CLEARWAY_SEES_truth sensing actuation drivers sumo metrics pipeline trace view samples links loop)
set(CLEARWAY_SEES_sensing pipeline trace samples links loop)

# Off: -Wrestrict, -Wnull-dereference and -Wmaybe-uninitialized. At -O3, GCC 12 finds them inside its own std::string (GCC bug
# 105651), std::vector and std::variant.
set(CLEARWAY_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
                      -Woverloaded-virtual -Wno-restrict -Wno-maybe-uninitialized -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)  # for libFuzzer alone: its warnings differ, and GCC's are the reference
    set(CLEARWAY_WARNINGS -w)
endif()

function(clearway_compile_options target)
    # -ffp-contract=off: the same sums on every optimisation level, hence the same trace hash.
    target_compile_options(${target} PRIVATE ${CLEARWAY_WARNINGS} -ffp-contract=off)
    if(CMAKE_UNITY_BUILD)
        # Types of an anonymous namespace may be members of a type of the same .cpp file, which is included here. A local name may
        # be that of a neighbour's constant; where files are compiled one by one, -Wshadow stays.
        target_compile_options(${target} PRIVATE -Wno-subobject-linkage -Wno-shadow)
    endif()
    if(CLEARWAY_ASSERTIONS)
        target_compile_options(${target} PRIVATE -UNDEBUG -D_GLIBCXX_ASSERTIONS)
    else()
        # What only an assertion uses is not used here; presets with assertions report the rest.
        target_compile_options(${target} PRIVATE -Wno-unused)
    endif()
    if(CLEARWAY_SANITIZE MATCHES thread)
        target_compile_options(${target} PRIVATE -Wno-tsan)  # Boost.Asio has fences, beside locks that the sanitizer knows
    endif()
    if(CLEARWAY_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=${CLEARWAY_SANITIZE} -fno-sanitize-recover=all
                                                 -fno-omit-frame-pointer)
        target_link_options(${target} PRIVATE -fsanitize=${CLEARWAY_SANITIZE})
    endif()
    if(CLEARWAY_SANITIZE MATCHES undefined)
        # Together a third of the compile time. Null pointers and objects that are too small end in an access that the address
        # sanitizer sees; x86-64 reads at any alignment; no code here casts down without dynamic_cast.
        target_compile_options(${target} PRIVATE -fno-sanitize=null,alignment,object-size,vptr)
    endif()
endfunction()

# clearway_module(NAME [USES module...] [PARTS folder...] [LINKS external...] [PUBLIC_LINKS external...])
# Sources are the .cpp files of the folder, of its detail/ and of the other folders that it names as its PARTS.
function(clearway_module name)
    cmake_parse_arguments(arg "" "" "USES;PARTS;LINKS;PUBLIC_LINKS" ${ARGN})
    set(folders . detail ${arg_PARTS})
    list(TRANSFORM folders APPEND /*.cpp OUTPUT_VARIABLE source_globs)
    list(TRANSFORM folders APPEND /*.hpp OUTPUT_VARIABLE header_globs)
    list(TRANSFORM source_globs PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    list(TRANSFORM header_globs PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    file(GLOB sources CONFIGURE_DEPENDS ${source_globs})
    file(GLOB headers CONFIGURE_DEPENDS ${header_globs})
    set(root ${CMAKE_BINARY_DIR}/roots/${name})
    file(MAKE_DIRECTORY ${root})
    file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${root}/${name} SYMBOLIC)

    set(target clearway_${name})
    set(scope PUBLIC)
    set(own PRIVATE)
    if(sources)
        add_library(${target} STATIC ${sources})
        clearway_compile_options(${target})
        # A unit parses its headers once: most of what a module costs to build.
        set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 24)
    else()
        add_library(${target} INTERFACE)
        set(scope INTERFACE)
        set(own INTERFACE)
    endif()
    add_library(clearway::${name} ALIAS ${target})
    foreach(used ${arg_USES})
        if(NOT TARGET clearway_${used})
            message(FATAL_ERROR "module ${name} uses ${used}, which does not stand below it")
        endif()
        target_link_libraries(${target} ${scope} $<LINK_ONLY:clearway_${used}>)
        target_link_libraries(${target} ${own} clearway_${used}_externals)
    endforeach()
    # Imported targets are known in this folder alone; what links this library finds them through it.
    add_library(clearway_${name}_externals INTERFACE)
    target_link_libraries(clearway_${name}_externals INTERFACE ${arg_PUBLIC_LINKS})
    target_link_libraries(${target} ${own} ${arg_LINKS} ${scope} clearway_${name}_externals)
    set_property(GLOBAL APPEND PROPERTY CLEARWAY_MODULES ${name})
    set_property(GLOBAL PROPERTY CLEARWAY_USES_${name} ${arg_USES})
    clearway_roots(declared ${name} ${arg_USES})
    target_include_directories(${target} ${own} ${declared})
    # Programs, tests and benchmarks are no modules: they see everything below what they use.
    clearway_closure(${name} below)
    clearway_roots(reached ${name} ${below})
    target_include_directories(${target} INTERFACE ${reached})

    foreach(file ${sources} ${headers})
        file(STRINGS ${file} climbing REGEX "#include \"\\.\\./")
        if(climbing)
            message(FATAL_ERROR "${file}: an include must not climb with ../ : ${climbing}")
        endif()
    endforeach()
    if(CLEARWAY_CHECK_HEADERS)
        clearway_headers_alone(${name} "${sources}" "${headers}")
        if(TARGET headers_${name})
            target_include_directories(headers_${name} PRIVATE ${declared})
            target_link_libraries(headers_${name} PRIVATE ${arg_LINKS} ${arg_PUBLIC_LINKS})
            foreach(used ${arg_USES})
                target_link_libraries(headers_${name} PRIVATE clearway_${used}_externals)
            endforeach()
        endif()
    endif()
endfunction()

# Include roots of these modules.
function(clearway_roots result)
    set(roots ${ARGN})
    list(TRANSFORM roots PREPEND ${CMAKE_BINARY_DIR}/roots/)
    set(${result} ${roots} PARENT_SCOPE)
endfunction()

# Compiles the headers that no source of the module includes first; the others are checked by that source.
function(clearway_headers_alone name sources headers)
    set(first)
    foreach(source ${sources})
        file(STRINGS ${source} include REGEX "^#include" LIMIT_COUNT 1)
        list(APPEND first "${include}")
    endforeach()
    set(units)
    foreach(header ${headers})
        cmake_path(RELATIVE_PATH header BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE relative)
        cmake_path(NORMAL_PATH relative)  # the folder itself is found as `.`
        if("#include \"${name}/${relative}\"" IN_LIST first)
            continue()
        endif()
        string(REPLACE "/" "_" flat ${relative})
        set(unit ${CMAKE_BINARY_DIR}/headers/${name}/${flat}.cpp)
        file(CONFIGURE OUTPUT ${unit} CONTENT "#include \"${name}/${relative}\"\n#include \"${name}/${relative}\"\n")
        list(APPEND units ${unit})
    endforeach()
    if(NOT units)
        return()
    endif()
    add_library(headers_${name} OBJECT ${units})
    clearway_compile_options(headers_${name})
endfunction()

function(clearway_closure name result)
    get_property(open GLOBAL PROPERTY CLEARWAY_USES_${name})
    set(seen)
    while(open)
        list(POP_FRONT open next)
        if(NOT next IN_LIST seen)
            list(APPEND seen ${next})
            get_property(more GLOBAL PROPERTY CLEARWAY_USES_${next})
            list(APPEND open ${more})
        endif()
    endwhile()
    set(${result} ${seen} PARENT_SCOPE)
endfunction()

# The library with core/build_stamp.hpp, which knows the sources of the program `worker` and of all modules below its own.
function(clearway_add_build_stamp worker module)
    clearway_closure(${module} closure)
    set(folders ${module} ${closure})
    list(TRANSFORM folders REPLACE "(.+)" "${CMAKE_SOURCE_DIR}/src/\\1/*" OUTPUT_VARIABLE globs)
    file(GLOB_RECURSE files RELATIVE ${CMAKE_SOURCE_DIR} CONFIGURE_DEPENDS ${globs} ${CMAKE_SOURCE_DIR}/programs/${worker}/*)
    list(SORT files)
    list(JOIN files "\n" lines)
    set(list ${CMAKE_BINARY_DIR}/build_stamp.txt)
    set(source ${CMAKE_BINARY_DIR}/build_stamp.cpp)
    file(CONFIGURE OUTPUT ${list} CONTENT "${lines}\n" @ONLY)
    set(script ${CMAKE_SOURCE_DIR}/cmake/build_stamp.cmake)
    list(TRANSFORM files PREPEND ${CMAKE_SOURCE_DIR}/)
    add_custom_command(
        OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -D OUTPUT=${source} -D LIST=${list} -D ROOT=${CMAKE_SOURCE_DIR} -P ${script}
        DEPENDS ${files} ${list} ${script}
        COMMENT "Stamping the build"
        VERBATIM)
    add_library(clearway_build_stamp STATIC ${source})
    target_link_libraries(clearway_build_stamp PRIVATE clearway_core)
    clearway_compile_options(clearway_build_stamp)
endfunction()

# CLEARWAY_COMMAND_FLAGS for modules in which no program spends its time: no simulation, import, statistics or training.
function(clearway_lighten)
    foreach(module ${ARGN})
        target_compile_options(clearway_${module} PRIVATE ${CLEARWAY_COMMAND_FLAGS})
    endforeach()
endfunction()

# Nothing after sensing sees the truth: neither prediction nor policy may reach it, however indirectly, and no module may
# see it that has no reason to.
function(clearway_check_layers)
    get_property(modules GLOBAL PROPERTY CLEARWAY_MODULES)
    foreach(module ${modules})
        get_property(uses GLOBAL PROPERTY CLEARWAY_USES_${module})
        foreach(guarded truth sensing)
            if(guarded IN_LIST uses AND NOT module IN_LIST CLEARWAY_SEES_${guarded})
                string(REPLACE ";" ", " seers "${CLEARWAY_SEES_${guarded}}")
                message(FATAL_ERROR "module ${module} uses ${guarded}, which only ${seers} may see. Remove it from "
                                    "src/${module}/CMakeLists.txt; docs/architecture.md says why")
            endif()
        endforeach()
    endforeach()
    foreach(blind prediction policy)
        if(blind IN_LIST modules)
            clearway_closure(${blind} closure)
            foreach(forbidden truth sumo sensing)
                if(forbidden IN_LIST closure)
                    message(FATAL_ERROR "module ${blind} can reach ${forbidden}: a policy or predictor must not see the truth. "
                                        "Remove what leads there from src/${blind}/CMakeLists.txt; docs/architecture.md says why")
                endif()
            endforeach()
        endif()
    endforeach()
endfunction()

# The allocator of processes that hold SUMO, which are a twelfth faster with it (docs/decisions/0017-a-worker.md). Where it
# is missing and under sanitizers, they take the C library's; results are the same.
find_library(CLEARWAY_ALLOCATOR NAMES libtcmalloc_minimal.so.4)
function(clearway_allocator target)
    if(CLEARWAY_ALLOCATOR AND NOT CLEARWAY_SANITIZE)
        target_link_libraries(${target} PRIVATE -Wl,--push-state,--no-as-needed ${CLEARWAY_ALLOCATOR} -Wl,--pop-state)
    endif()
endfunction()

# Where OpenBLAS multiplies with fewer digits than single precision has.
file(STRINGS /proc/cpuinfo CLEARWAY_SHORT_PRODUCTS REGEX avx512_bf16 LIMIT_COUNT 1)

# clearway_test(NAME SOURCES file... USES module... [LINKS ...] [LABELS fast|sumo|torch|slow|browser|threads|optional]
#               [TIMEOUT seconds] [COST seconds])
# A fast program is one entry of CTest, because starting it for each of its tests takes longer than the tests; so is one that
# links libtorch, which takes longest to start and is not everywhere. Of the others each test is an entry, so that they run side
# by side. COST is a guess at the time of an entry: the longest start first.
function(clearway_test name)
    cmake_parse_arguments(arg "" "TIMEOUT;COST" "SOURCES;USES;LINKS;LABELS" ${ARGN})
    if(NOT arg_TIMEOUT)
        set(arg_TIMEOUT 300)
    endif()
    if(NOT arg_COST)
        set(arg_COST 1)
    endif()
    add_executable(${name} ${arg_SOURCES})
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    foreach(used ${arg_USES})
        target_link_libraries(${name} PRIVATE clearway_${used})
    endforeach()
    target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
    target_link_libraries(${name} PRIVATE ${arg_LINKS} GTest::gmock_main)
    target_compile_definitions(${name} PRIVATE CLEARWAY_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                                               CLEARWAY_BINARY_DIR="${CMAKE_BINARY_DIR}")
    clearway_compile_options(${name})
    target_compile_options(${name} PRIVATE ${CLEARWAY_TEST_FLAGS})
    set(fixtures)
    foreach(used ${arg_USES})
        clearway_closure(${used} below)
        if(used STREQUAL policy OR policy IN_LIST below)
            set(fixtures FIXTURES_REQUIRED policy_names)  # tests/policy/CMakeLists.txt
        endif()
    endforeach()
    if("fast" IN_LIST arg_LABELS AND NOT CLEARWAY_FAST_TESTS)
        set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    elseif("fast" IN_LIST arg_LABELS OR "torch" IN_LIST arg_LABELS)
        add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
        set_tests_properties(${name} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT} COST ${arg_COST} ${fixtures})
        if("torch" IN_LIST arg_LABELS AND CLEARWAY_SHORT_PRODUCTS)  # as src/cli/train.cpp
            set_tests_properties(${name} PROPERTIES ENVIRONMENT OPENBLAS_CORETYPE=SkylakeX)
        endif()
    else()
        gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 DISCOVERY_MODE PRE_TEST
                             PROPERTIES TIMEOUT ${arg_TIMEOUT} COST ${arg_COST} ${fixtures})
        # It takes no list for a property, so CTest reads the labels after the tests.
        set(labels ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
        file(CONFIGURE OUTPUT ${labels} @ONLY CONTENT
            "if(@name@_TESTS)\n    set_tests_properties(\${@name@_TESTS} PROPERTIES LABELS \"@arg_LABELS@\")\nendif()\n")
        set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels})
    endif()
    foreach(label ${arg_LABELS})
        if(NOT TARGET tests_${label})
            add_custom_target(tests_${label})  # the programs with this label
        endif()
        add_dependencies(tests_${label} ${name})
    endforeach()
endfunction()
