#include "app/live/quick_window.hpp"

#include <vtkRenderWindow.h>

#if __has_include(<vtkXOpenGLRenderWindow.h>)

#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>
#include <vtkXOpenGLRenderWindow.h>

#include <GL/glx.h>

namespace weir::live {

namespace {

class QuickWindow : public vtkXOpenGLRenderWindow {
public:
    static QuickWindow* New();
    vtkTypeMacro(QuickWindow, vtkXOpenGLRenderWindow) QuickWindow(const QuickWindow&) = delete;
    QuickWindow& operator=(const QuickWindow&) = delete;

    /// The end of a frame: what was drawn becomes what is seen.
    void Frame() override {
        if (!SwapBuffers || AbortRender || MultiSamples > 0 || !DoubleBuffer || UseOffScreenBuffers || WindowId == 0)
            return Superclass::Frame();
        MakeCurrent();
        vtkOpenGLState* state = GetState();
        state->PushFramebufferBindings();
        RenderFramebuffer->Bind(GL_READ_FRAMEBUFFER);
        RenderFramebuffer->ActivateReadBuffer(0);
        state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        state->vtkglDrawBuffer(GL_BACK_LEFT);
        state->vtkglViewport(0, 0, Size[0], Size[1]);
        state->vtkglScissor(0, 0, Size[0], Size[1]);
        state->vtkglBlitFramebuffer(0, 0, Size[0], Size[1], 0, 0, Size[0], Size[1], GL_COLOR_BUFFER_BIT, GL_NEAREST);
        state->PopFramebufferBindings();
        glXSwapBuffers(DisplayId, WindowId);
    }

private:
    QuickWindow() = default;
};

vtkStandardNewMacro(QuickWindow);

}  // namespace

vtkSmartPointer<vtkRenderWindow> quick_window() { return vtkSmartPointer<QuickWindow>::New(); }

}  // namespace weir::live

#else

namespace weir::live {

vtkSmartPointer<vtkRenderWindow> quick_window() { return vtkSmartPointer<vtkRenderWindow>::New(); }

}  // namespace weir::live

#endif
