# cmake -DPROGRAM=keeler -DFOLDER=man -DDATE=2026-11-27 -P man_pages.cmake: writes a manual page for each command, and keeler.1 last, from
# the texts of --help.
cmake_minimum_required(VERSION 3.20)

# Sets `result` to the output of the program.
function(ask result)
  execute_process(COMMAND "${PROGRAM}" ${ARGN} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# Sets `result` to the commands below these words.
function(commands_below result)
  execute_process(COMMAND "${PROGRAM}" complete keeler help ${ARGN} "" OUTPUT_VARIABLE offered COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "\n[a-z]+\t" lines "${offered}")
  string(REGEX REPLACE "[\n\t]" "" commands "${lines}")
  set(${result} "${commands}" PARENT_SCOPE)
endfunction()

# Sets `result` to the help on a command in roff. Its first line is the description.
function(help_in_roff result)
  ask(text ${ARGN} --help)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REGEX REPLACE "^([^\n]*)\nUsage: ([^\n]*)" "\n.PP\n.B \\2\n.PP\n\\1" text "${text}")
  string(REGEX REPLACE "\nExamples:(.*)" "\n.SS Examples\n.nf\\1.fi\n" text "${text}")
  # Descriptions begin in column 30, or on a line of their own below a long option.
  string(REPEAT "[^\n]" 27 option)
  string(REGEX REPLACE "\n  (-[^\n]*)\n          +" "\n.TP\n.B \\1\n" text "${text}")
  string(REGEX REPLACE "\n  (${option}) ([^ \n][^\n]*)" "\n.TP\n.B \\1\n\\2" text "${text}")
  string(REGEX REPLACE "\n([A-Z][a-z]+):" "\n.SS \\1" text "${text}")
  string(REGEX REPLACE " *\n+" "\n" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# Writes the page of a command, with its subcommands.
function(write_page)
  set(page keeler ${ARGN})
  list(JOIN page "-" page)
  string(TOUPPER "${page}" title)
  ask(help ${ARGN} --help)
  string(REGEX MATCH "^[^\n]*" about "${help}")
  help_in_roff(body ${ARGN})
  if(ARGN)
    commands_below(parts ${ARGN})
    foreach(part IN LISTS parts)
      help_in_roff(more ${ARGN} ${part})
      string(APPEND body ".SH ${part}${more}")
    endforeach()
  else()
    string(REGEX REPLACE "\n.TP\n.B ([a-z]+)\n" "\n.TP\n\\\\fBkeeler\\\\-\\1\\\\fR(1)\n" body "${body}")
  endif()
  file(WRITE "${FOLDER}/${page}.1" ".TH ${title} 1 \"${DATE}\" \"${version}\" \"Keeler\"
.SH NAME
${page} \\- ${about}
.SH DESCRIPTION${body}.SH EXIT STATUS
.nf
0: all that was asked is done.
1: an error that none of the following covers.
2: the command line or the scene is wrong.
3: a physical invariant broke.
4: reading or writing failed.
75: stopped early on request, with a valid checkpoint on disk.
.fi
.SH SEE ALSO
.BR keeler (1),
the manual (commands, scene keys, a tutorial) in the folder doc/keeler beside the folder of this page.
")
endfunction()

file(MAKE_DIRECTORY "${FOLDER}")
ask(version --version)
string(STRIP "${version}" version)
commands_below(commands)
foreach(command IN LISTS commands)
  write_page(${command})
endforeach()
write_page()
