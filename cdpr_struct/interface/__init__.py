"""The functions behind `import cdpr_struct`: one a command, arguments named like its options."""
