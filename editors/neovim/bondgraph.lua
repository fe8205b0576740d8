-- Neovim 0.11 or newer: put this file into ~/.config/nvim/lsp/ and say vim.lsp.enable("bondgraph").
-- Colours come from the server (semantic tokens) and from bondgraph.vim beside this file.
vim.filetype.add({ extension = { bg = "bondgraph" } })

return {
  cmd = { "bondgraph", "lsp" },
  filetypes = { "bondgraph" },
  root_markers = { ".git" },
}
