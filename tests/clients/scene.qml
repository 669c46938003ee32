// What Qt Quick draws: gradients, turned and layered rectangles, text.
import QtQuick
import QtQuick.Window

Window {
    visible: true
    visibility: Window.FullScreen
    width: 640
    height: 480
    color: "#203040"
    Rectangle {
        x: 60; y: 40; width: 300; height: 200; radius: 24; rotation: 17
        gradient: Gradient {
            GradientStop { position: 0; color: "#ff8040" }
            GradientStop { position: 1; color: "#4080ff" }
        }
    }
    Rectangle {
        x: 250; y: 180; width: 260; height: 220; opacity: 0.6; color: "#60c080"; layer.enabled: true
        border.width: 5; border.color: "#ffffff"; antialiasing: true; rotation: -8
    }
    Text { x: 90; y: 400; text: "Qt Quick on Vulkan"; color: "#ffffc0"; font.pixelSize: 40 }
}
