// grows with the module
