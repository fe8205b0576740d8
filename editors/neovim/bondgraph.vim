" Vim and Neovim: put this file into ~/.vim/syntax/ or ~/.config/nvim/syntax/.
if exists("b:current_syntax")
  finish
endif
syntax match bondgraphName "\<\h\w*\>"
syntax match bondgraphType "\<\%([01]\|\h\w*\)\ze\s*:\s*\h"
syntax match bondgraphNumber "\%(\w\|\.\)\@1<!\d\+\%(\.\d\+\)\=\%([eE][+-]\=\d\+\)\="
syntax match bondgraphUnit "\%(\d \)\@2<=\%(\%(and\|or\|not\|unknown\|counts\|when\|else\)\>\)\@!\h[A-Za-z0-9_./^-]*"
syntax match bondgraphArrow "<-\[\s*\w\+\s*\]-\|-\[\s*\w\+\s*\]->\|->\|<-"
syntax match bondgraphKeyword "\%(^\|[;{}]\)\s*\zs\%(model\|import\|port\|param\|const\|input\|sensor\|let\|fault\|for\)\ze\s\+\h"
syntax match bondgraphKeyword "\%(^\|[;{}]\)\s*\zsif\ze[ (]"
syntax match bondgraphKeyword "\<\%(else\ze\s*\%({\|if\>\)\|when\|counts\|unknown\|from\ze\s*\"\)"
syntax match bondgraphKeyword "^\s*bg\ze\s\+\d"
syntax keyword bondgraphWord and or not
syntax keyword bondgraphConstant true false
syntax region bondgraphString start=+"+ end=+"+ oneline
syntax match bondgraphComment "#.*$" contains=@Spell
syntax match bondgraphDoc "##\%(#\)\@!.*$" contains=@Spell

highlight default link bondgraphType Type
highlight default link bondgraphNumber Number
highlight default link bondgraphUnit StorageClass
highlight default link bondgraphArrow Operator
highlight default link bondgraphKeyword Keyword
highlight default link bondgraphWord Operator
highlight default link bondgraphConstant Boolean
highlight default link bondgraphString String
highlight default link bondgraphComment Comment
highlight default link bondgraphDoc SpecialComment
setlocal commentstring=#\ %s
let b:current_syntax = "bondgraph"
