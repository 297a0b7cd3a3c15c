# cmake -DINPUT=facs.toml -DOUTPUT=facs_toml.inc -P EmbedText.cmake: a text file as C++ string literals, one a line.
file(READ ${INPUT} text)
string(REPLACE "\\" "\\\\" text "${text}")
string(REPLACE "\"" "\\\"" text "${text}")
string(REPLACE "\n" "\\n\"\n\"" text "${text}")
file(WRITE ${OUTPUT} "\"${text}\"\n")
