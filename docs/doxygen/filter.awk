# Comments as Doxygen wants them: the first lines of a file are about the file, a remark behind a declaration is about that.
FNR == 1 && /^\/\/ / { print "/// \\file"; opening = 1 }
opening && /^\/\// { sub(/^\/\//, "///"); print; next }
{ opening = 0 }
/[;,{})] +\/\/ / && !/\/\/\// { match($0, /[;,{})] +\/\/ /); $0 = substr($0, 1, RSTART) "  ///< " substr($0, RSTART + RLENGTH) }
{ print }
