//! An object in the making: its symbols, its data and the functions that are written for it.

use std::fmt;

use cranelift_codegen::Context;
use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::ir::{
    AbiParam, FuncRef, Function as Ir, InstBuilder, MemFlagsData, Signature, SourceLoc, Type, UserFuncName, Value,
    types,
};
use cranelift_codegen::isa::CallConv;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::{DataDescription, DataId, FuncId, Linkage, Module, ModuleReloc};
use cranelift_object::object::write::Symbol as ObjectSymbol;
use cranelift_object::object::{FileFlags, SymbolFlags, SymbolScope, elf};
use cranelift_object::{ObjectBuilder, ObjectModule};

use super::{Function, Role};
use crate::engine::clif::{Chunk, CompileError};
use crate::engine::target::Target;
use crate::interface::{Interface, Symbol};

/// What a symbol of data holds.
pub(super) enum Contents {
    /// So many bytes of zero, which take no room in the file.
    Zeros(u32),
    /// Constant bytes, in the order of a target that has the least first, as all of them have.
    Bytes(Vec<u8>),
}

/// The widest alignment of data here, that of an image.
const ALIGNMENT: u64 = crate::logic::image::ALIGNMENT as u64;

pub(super) struct Assembly<'a> {
    module: ObjectModule,
    interface: &'a Interface,
    target: &'a Target,
    context: Context,
    frontend: FunctionBuilderContext,
    functions: Vec<Function>,
    /// The function that copies, once it is written.
    copy: Option<FuncId>,
}

/// A function in the making.
pub(super) struct Body<'f> {
    pub(super) builder: FunctionBuilder<'f>,
    module: &'f mut ObjectModule,
}

/// That the object could not be written, which is nobody's fault but ours or Cranelift's.
pub(super) fn refused(reason: impl fmt::Display) -> CompileError {
    CompileError::Object(reason.to_string())
}

impl<'a> Assembly<'a> {
    pub(super) fn new(interface: &'a Interface, target: &'a Target) -> Result<Self, CompileError> {
        let no_names = cranelift_module::default_libcall_names();
        let builder = ObjectBuilder::new(target.isa().clone(), interface.prefix(), no_names).map_err(refused)?;
        let module = ObjectModule::new(builder);
        let (context, frontend) = (Context::new(), FunctionBuilderContext::new());
        Ok(Self { module, interface, target, context, frontend, functions: Vec::new(), copy: None })
    }

    /// The name of something that is not exported.
    fn local(&self, name: &str) -> String {
        format!("{}.{name}", self.interface.prefix())
    }

    pub(super) fn call_convention(&self) -> CallConv {
        CallConv::triple_default(self.target.triple())
    }

    pub(super) fn interface(&self) -> &'a Interface {
        self.interface
    }

    /// Data that firmware sees; constant, but for zeros.
    pub(super) fn export_data(&mut self, symbol: Symbol, contents: Contents) -> Result<(), CompileError> {
        let name = self.interface.symbol(symbol);
        self.data(&name, Linkage::Export, contents).map(|_| ())
    }

    /// Data of the object's own; constant, but for zeros.
    pub(super) fn local_data(&mut self, name: &str, contents: Contents) -> Result<DataId, CompileError> {
        let name = self.local(name);
        self.data(&name, Linkage::Local, contents)
    }

    fn data(&mut self, name: &str, linkage: Linkage, contents: Contents) -> Result<DataId, CompileError> {
        let mut description = DataDescription::new();
        let writable = matches!(contents, Contents::Zeros(_));
        let align = match contents {
            Contents::Zeros(size) => {
                description.define_zeroinit(size as usize);
                if size == 4 { 4 } else { ALIGNMENT }
            }
            Contents::Bytes(bytes) => {
                let align = if bytes.len() == 4 { 4 } else { ALIGNMENT };
                description.define(bytes.into_boxed_slice());
                align
            }
        };
        description.set_align(align);
        let id = self.module.declare_data(name, linkage, writable, false).map_err(refused)?;
        self.module.define_data(id, &description).map_err(refused)?;
        Ok(id)
    }

    /// A table of pointers to functions, with none in the rows that are left out.
    pub(super) fn table(&mut self, name: &str, rows: &[Option<FuncId>]) -> Result<DataId, CompileError> {
        let name = self.local(name);
        let mut description = DataDescription::new();
        description.define(vec![0; 8 * rows.len()].into_boxed_slice());
        description.set_align(8);
        for (row, function) in rows.iter().enumerate() {
            if let Some(function) = function {
                let function = self.module.declare_func_in_data(*function, &mut description);
                description.write_function_addr(u32::try_from(8 * row).unwrap_or(u32::MAX), function);
            }
        }
        let id = self.module.declare_data(&name, Linkage::Local, false, false).map_err(refused)?;
        self.module.define_data(id, &description).map_err(refused)?;
        Ok(id)
    }

    fn signature(&self, params: &[Type], returns: &[Type]) -> Signature {
        let mut signature = Signature::new(self.call_convention());
        signature.params.extend(params.iter().map(|ty| AbiParam::new(*ty)));
        signature.returns.extend(returns.iter().map(|ty| AbiParam::new(*ty)));
        signature
    }

    /// A function whose code is there already, and that is called with these parameters.
    pub(super) fn compiled(&mut self, name: &str, chunk: &Chunk, params: &[Type]) -> Result<FuncId, CompileError> {
        let (name, signature) = (self.local(name), self.signature(params, &[]));
        let id = self.module.declare_function(&name, Linkage::Local, &signature).map_err(refused)?;
        let alignment = u64::from(chunk.alignment);
        self.module.define_function_bytes(id, alignment, &chunk.code, &[]).map_err(refused)?;
        Ok(id)
    }

    /// Writes a function that firmware calls.
    pub(super) fn export(
        &mut self,
        symbol: Symbol,
        role: Role,
        params: &[Type],
        write: impl FnOnce(&mut Body<'_>, &[Value]),
    ) -> Result<(), CompileError> {
        let name = self.interface.symbol(symbol);
        let write = |body: &mut Body<'_>, params: &[Value]| {
            write(body, params);
            body.builder.ins().return_(&[]);
        };
        self.function(name, Linkage::Export, role, params, &[], write).map(|_| ())
    }

    /// Writes a function of the object's own, with its return.
    pub(super) fn local_function(
        &mut self,
        name: &str,
        role: Role,
        params: &[Type],
        returns: &[Type],
        write: impl FnOnce(&mut Body<'_>, &[Value]),
    ) -> Result<FuncId, CompileError> {
        let name = self.local(name);
        self.function(name, Linkage::Local, role, params, returns, write)
    }

    fn function(
        &mut self,
        name: String,
        linkage: Linkage,
        role: Role,
        params: &[Type],
        returns: &[Type],
        write: impl FnOnce(&mut Body<'_>, &[Value]),
    ) -> Result<FuncId, CompileError> {
        let signature = self.signature(params, returns);
        let id = self.module.declare_function(&name, linkage, &signature).map_err(refused)?;
        self.context.clear();
        self.context.func = Ir::with_name_signature(UserFuncName::user(0, id.as_u32()), signature);
        let isa = self.target.isa();
        let mut builder = FunctionBuilder::new(&mut self.context.func, &mut self.frontend);
        let block = builder.create_block();
        builder.append_block_params_for_function_params(block);
        builder.switch_to_block(block);
        // Instructions end where the last place in a source does.
        builder.set_srcloc(SourceLoc::new(1));
        let params = builder.block_params(block).to_vec();
        let mut body = Body { builder, module: &mut self.module };
        write(&mut body, &params);
        body.builder.seal_all_blocks();
        body.builder.finalize(isa.frontend_config());
        self.context.compile(&**isa, &mut ControlPlane::default()).map_err(|error| refused(error.inner))?;
        let Some(compiled) = self.context.compiled_code() else { return Err(refused("no code")) };
        let code = compiled.code_buffer().to_vec();
        let ends = compiled.buffer.get_srclocs_sorted().iter().map(|location| location.end as usize);
        let instruction_bytes = ends.max().unwrap_or(code.len());
        let relocations: Vec<ModuleReloc> = compiled
            .buffer
            .relocs()
            .iter()
            .map(|relocation| ModuleReloc::from_mach_reloc(relocation, &self.context.func, id))
            .collect();
        let alignment = u64::from(isa.function_alignment().minimum.max(compiled.buffer.alignment));
        self.module.define_function_bytes(id, alignment, &code, &relocations).map_err(refused)?;
        self.functions.push(Function { name, role, code, instruction_bytes });
        Ok(id)
    }

    pub(super) fn copy_function(&self) -> Option<FuncId> {
        self.copy
    }

    pub(super) fn set_copy_function(&mut self, copy: FuncId) {
        self.copy = Some(copy);
    }

    /// The file, with `round` exported as `P_scan`, and the code that was written for it.
    pub(super) fn finish(self, round: FuncId) -> Result<(Vec<u8>, Vec<Function>), CompileError> {
        let mut product = self.module.finish();
        if let Some(e_flags) = self.target.elf_flags() {
            // Cranelift marks every RISC-V object as one that passes reals in registers for them.
            product.object.flags = FileFlags::Elf { os_abi: elf::ELFOSABI_NONE, abi_version: 0, e_flags };
        }
        let round = product.object.symbol(product.function_symbol(round));
        let scan = ObjectSymbol {
            name: self.interface.symbol(Symbol::Scan).into_bytes(),
            value: round.value,
            size: round.size,
            kind: round.kind,
            scope: SymbolScope::Dynamic,
            weak: false,
            section: round.section,
            flags: SymbolFlags::None,
        };
        product.object.add_symbol(scan);
        let bytes = product.emit().map_err(refused)?;
        Ok((bytes, self.functions))
    }
}

/// What accesses to memory here are: aligned, and never outside of it.
pub(super) fn plain() -> MemFlagsData {
    MemFlagsData::trusted()
}

impl Body<'_> {
    /// The address of data.
    pub(super) fn address(&mut self, data: DataId) -> Value {
        let data = self.module.declare_data_in_func(data, self.builder.func);
        self.builder.ins().symbol_value(types::I64, data)
    }

    /// A function, to be called.
    pub(super) fn callee(&mut self, function: FuncId) -> FuncRef {
        self.module.declare_func_in_func(function, self.builder.func)
    }

    pub(super) fn call(&mut self, function: FuncId, arguments: &[Value]) {
        let function = self.callee(function);
        self.builder.ins().call(function, arguments);
    }

    /// A number of 64 bits.
    pub(super) fn number(&mut self, number: i64) -> Value {
        self.builder.ins().iconst(types::I64, number)
    }

    /// A pointer so many bytes on.
    pub(super) fn offset(&mut self, pointer: Value, bytes: u32) -> Value {
        if bytes == 0 { pointer } else { self.builder.ins().iadd_imm_s(pointer, i64::from(bytes)) }
    }

    /// All ones where a comparison holds, else 0, in 64 bits.
    pub(super) fn mask(&mut self, holds: Value) -> Value {
        let one = self.builder.ins().uextend(types::I64, holds);
        self.builder.ins().ineg(one)
    }
}
