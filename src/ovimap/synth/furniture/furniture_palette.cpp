// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/synth/furniture/furniture_palette.h"

#include "ovimap/base/config.h"
#include "ovimap/base/error.h"

namespace ovimap {
namespace {

struct PaletteClass {
  std::string name;
  std::vector<std::string> models;
};

const std::vector<PaletteClass>& palette() {
  static const std::vector<PaletteClass> classes = {
      {"wall", {}},
      {"floor", {}},
      {"ceiling", {}},
      {"door", {"Scopia/door", "Scopia/puerta"}},
      {"window", {"Scopia/window_2x1_medium_with_large_pane"}},
      {"picture", {}},
      {"rug", {}},
      {"ceiling lamp", {"Scopia/ceiling-lamp"}},
      {"sofa",
       {"BlendSwap-CC-0/sofa2", "BlendSwap-CC-0/winchesterSofa", "BlendSwap-CC-BY/sofa3",
        "BlendSwap-CC-BY/couch3", "Scopia/simple_sofa", "Scopia/beige_sofa_2seats",
        "Scopia/beige_sofa", "Scopia/burlap_sofa", "Scopia/leather_sofa", "Scopia/sofa_white_beige",
        "Scopia/clear_sofa", "KatorLegaz/futon-couch"}},
      {"armchair",
       {"BlendSwap-CC-0/winchesterArmchair", "BlendSwap-CC-BY/armchair1", "BlendSwap-CC-BY/fotel",
        "Scopia/armchair3", "Scopia/armchair", "Scopia/armchair2", "BlendSwap-CC-BY/armChair2"}},
      {"chair",
       {"BlendSwap-CC-0/oakChair", "BlendSwap-CC-0/plasticChair", "BlendSwap-CC-0/chairWithCushion",
        "BlendSwap-CC-0/chair2", "BlendSwap-CC-0/osakaChair", "BlendSwap-CC-BY/chairWithCushion",
        "BlendSwap-CC-BY/ella_chair_f", "BlendSwap-CC-BY/plaidChair", "BlendSwap-CC-BY/chair3",
        "Scopia/chair3", "Scopia/chair4", "Scopia/chair", "Scopia/plastic_chair",
        "KatorLegaz/dining-chair"}},
      {"office chair",
       {"Scopia/office_chair", "KatorLegaz/office-chair", "BlendSwap-CC-0/armchair"}},
      {"stool", {"BlendSwap-CC-BY/green_stool", "BlendSwap-CC-0/stool2"}},
      {"bench", {"KatorLegaz/bench"}},
      {"table",
       {"BlendSwap-CC-0/oakTable", "BlendSwap-CC-0/table", "BlendSwap-CC-BY/table", "Scopia/table4",
        "Scopia/wooden_table_office", "Scopia/white_kitchen_table",
        "Scopia/wooden_office_alder_table", "KatorLegaz/folding-table"}},
      {"coffee table", {"BlendSwap-CC-BY/coffeeTable", "Scopia/saloon_table"}},
      {"desk",
       {"BlendSwap-CC-0/lbDesk", "BlendSwap-CC-BY/biurko3", "BlendSwap-CC-BY/simpleDesk",
        "Scopia/kids_wooden_desk", "Scopia/wooden_office_pear_table_rect"}},
      {"bookshelf",
       {"KatorLegaz/full-bookcase", "BlendSwap-CC-0/bookcase", "BlendSwap-CC-BY/bookcase",
        "KatorLegaz/utility-shelving", "Scopia/kids_shelves", "BlendSwap-CC-0/verticalShelves"}},
      {"cabinet",
       {"BlendSwap-CC-0/shelves", "BlendSwap-CC-BY/dresserWithDrawers", "BlendSwap-CC-BY/chest",
        "Scopia/box_room", "BlendSwap-CC-0/cupboard"}},
      {"wardrobe",
       {"BlendSwap-CC-BY/wardrobe", "BlendSwap-CC-BY/wardrobe2", "Scopia/wardrobe1",
        "BlendSwap-CC-0/wardrobeWithSlidingDoors"}},
      {"tv stand", {"BlendSwap-CC-BY/tvStand"}},
      {"nightstand", {"BlendSwap-CC-0/bedsideTable2", "BlendSwap-CC-BY/bedsideTable"}},
      {"bed",
       {"BlendSwap-CC-0/bed1", "BlendSwap-CC-0/bed2", "BlendSwap-CC-0/bed3",
        "BlendSwap-CC-BY/juniorBed", "BlendSwap-CC-BY/lettoCloud", "Scopia/bed1",
        "Scopia/iron_bed"}},
      {"lamp",
       {"Scopia/little_lamp1", "Scopia/little_lamp2", "Scopia/table_lamp", "BlendSwap-CC-BY/lamp",
        "BlendSwap-CC-0/desklamp", "Scopia/desk_lamp1", "Scopia/desk_lamp2"}},
      {"floor lamp", {"Scopia/living_lamp"}},
      {"plant",
       {"BlendSwap-CC-0/plant", "BlendSwap-CC-0/decorativePlant", "BlendSwap-CC-BY/spatifilum",
        "BlendSwap-CC-BY/decorativePlant", "Scopia/maceta", "BlendSwap-CC-BY/mediumIndoorPlant"}},
      {"potted plant",
       {"BlendSwap-CC-0/littlePlant", "BlendSwap-CC-0/cactus", "BlendSwap-CC-BY/succulentPlant",
        "BlendSwap-CC-BY/luckyBamboo", "BlendSwap-CC-0/orchids"}},
      {"flowers", {"BlendSwap-CC-BY/tulip", "BlendSwap-CC-BY/tulips"}},
      {"vase", {"Scopia/vase1", "Scopia/vase2", "Scopia/vase3", "Scopia/jar"}},
      {"mug", {"KatorLegaz/coffee-mug", "Scopia/cup", "BlendSwap-CC-BY/coffee_cup"}},
      {"bowl", {"Scopia/bowl", "Scopia/bowlWithFruits", "Scopia/apples", "KatorLegaz/bowl"}},
      {"bottle", {"Scopia/wine_bottle", "KatorLegaz/red-wine-bottle-01"}},
      {"plate", {"KatorLegaz/dinner-plate"}},
      {"teapot", {"Scopia/teapot"}},
      {"book", {"BlendSwap-CC-BY/book"}},
      {"newspaper", {"KatorLegaz/newspaper"}},
      {"laptop", {"BlendSwap-CC-BY/laptop", "KatorLegaz/apple-ibook-2001"}},
      {"tablet", {"Scopia/tablet"}},
      {"computer", {"Scopia/apple_pc", "KatorLegaz/apple-imac-1998"}},
      {"printer", {"Scopia/inkjet_and_scanner_printer"}},
      {"telephone", {"Scopia/phone"}},
      {"tv", {"BlendSwap-CC-0/led_tv", "Scopia/tv"}},
      {"stereo", {"Scopia/mini_stereo", "BlendSwap-CC-BY/radio"}},
      {"speaker", {"BlendSwap-CC-0/speaker2", "BlendSwap-CC-0/speaker3"}},
      {"keyboard instrument", {"KatorLegaz/MIDI-keyboard"}},
      {"piano", {"BlendSwap-CC-BY/piano"}},
      {"guitar", {"BlendSwap-CC-0/electricGuitar"}},
      {"fan", {"BlendSwap-CC-0/tableFan"}},
      {"clock", {"BlendSwap-CC-0/cuckooClock"}},
      {"photo frame", {"Scopia/frame1", "Scopia/frame2"}},
      {"calendar", {"BlendSwap-CC-0/kalender"}},
      {"pen holder", {"Scopia/penbox"}},
      {"letter tray", {"Scopia/bandeja"}},
      {"headphones", {"BlendSwap-CC-0/headphones"}},
      {"trash can",
       {"BlendSwap-CC-0/dustbin", "KatorLegaz/bullet-trash-can", "KatorLegaz/recycling-bin"}},
      {"box", {"Scopia/cardboard-box", "BlendSwap-CC-0/crate", "BlendSwap-CC-BY/gift"}},
      {"ball", {"BlendSwap-CC-0/basketball", "BlendSwap-CC-BY/ballonFoot"}},
      {"teddy bear", {"BlendSwap-CC-0/teddyBear"}},
      {"toy", {"BlendSwap-CC-BY/toyTrain", "BlendSwap-CC-BY/carrito-de-madera"}},
      {"backpack", {"BlendSwap-CC-BY/backpack"}},
      {"bag", {"BlendSwap-CC-0/briefcase", "BlendSwap-CC-0/handbag"}},
      {"suitcase", {"BlendSwap-CC-BY/suitcase"}},
      {"shoes", {"Scopia/sneakers", "BlendSwap-CC-0/slippers"}},
      {"clothes", {"Scopia/folded_clothes"}},
      {"radiator", {"BlendSwap-CC-BY/modernRadiator", "BlendSwap-CC-0/radiator3"}},
      {"curtain", {"Scopia/curtain"}},
      {"refrigerator",
       {"BlendSwap-CC-0/largeFridge", "BlendSwap-CC-0/refrigerator", "KatorLegaz/fridge"}},
      {"stove", {"BlendSwap-CC-BY/largeStove"}},
      {"washing machine", {"Scopia/clothes_washing_machine", "BlendSwap-CC-BY/washing_machine"}},
      {"kitchen cabinet",
       {"BlendSwap-CC-0/drawersCabinet", "BlendSwap-CC-0/lowerCabinet",
        "BlendSwap-CC-BY/kitchenLowerCabinet"}},
      {"sink", {"BlendSwap-CC-0/sinkCabinet", "BlendSwap-CC-BY/kitchenSink"}},
      {"microwave", {"BlendSwap-CC-BY/microwave"}},
      {"toaster", {"Scopia/toaster"}},
      {"coffee machine", {"BlendSwap-CC-0/coffeeBrewer", "KatorLegaz/coffee-maker"}},
      {"knife block", {"Scopia/kitchenKnifeStandSet"}},
      {"chopping board", {"BlendSwap-CC-BY/choppingBoard"}},
      {"paper towel", {"Scopia/paperTowelHolder"}},
      {"cake", {"Scopia/birthday_cake"}},
      {"whiteboard", {"BlendSwap-CC-0/whiteBoard"}},
      {"filing cabinet", {"KatorLegaz/filing-cabinet"}},
      {"water cooler", {"Scopia/water_cooler"}},
      {"fire extinguisher", {"BlendSwap-CC-0/fireExtinguisher"}},
      {"wall cabinet",
       {"BlendSwap-CC-0/upperCabinet", "BlendSwap-CC-BY/kitchenUpperCabinet",
        "BlendSwap-CC-0/upperShelves"}},
      {"range hood", {"BlendSwap-CC-0/rangeHood"}},
      {"oven", {"BlendSwap-CC-0/doubleOven", "Scopia/small-oven"}},
      {"pot", {"BlendSwap-CC-BY/largePan"}},
      {"kettle", {"BlendSwap-CC-BY/boiler"}},
      {"mixer", {"BlendSwap-CC-0/kitchenaid"}},
      {"kitchen scale", {"BlendSwap-CC-BY/kitchenScale"}},
      {"bread", {"BlendSwap-CC-0/bread"}},
      {"milk carton", {"BlendSwap-CC-0/tetrapak"}},
      {"toilet",
       {"BlendSwap-CC-0/toiletsUnit", "BlendSwap-CC-BY/toilets_unit_jay_hardy",
        "BlendSwap-CC-BY/modernToilet"}},
      {"bathtub", {"BlendSwap-CC-BY/bath_jay_hardy", "Scopia/islandBath"}},
      {"shower", {"BlendSwap-CC-0/showerStall"}},
      {"washbasin", {"BlendSwap-CC-BY/washbasin_jay_hardy"}},
      {"towel", {"BlendSwap-CC-0/towel3", "Scopia/com_bath3", "Scopia/com_bath3_toalla"}},
      {"toilet paper", {"BlendSwap-CC-0/toiletPaperDispenser"}},
      {"soap dispenser", {"Scopia/com_bath2_soap"}},
      {"laundry basket", {"Scopia/clothes-basket"}},
      {"candle", {"Scopia/candle"}},
      {"dollhouse", {"Scopia/doll-house"}},
      {"rocking horse", {"BlendSwap-CC-0/caballito"}},
      {"game controller", {"Scopia/ps4-joystick"}},
      {"projector", {"Scopia/video-projector"}},
      {"bicycle", {"Scopia/bicycle"}},
      {"pillow", {}},
      {"blanket", {}},
      // Made by rule (synth/procedural):
      {"monitor", {}},
      {"barbell", {}},
      {"shelf", {}},
      {"drinking glass", {}},
      {"can", {}},
      {"cutlery", {}},
      {"carton", {}},
      {"tray", {}},
      {"keyboard", {}},
      {"computer mouse", {}},
      {"mouse pad", {}},
      {"paper", {}},
      {"folder", {}},
      {"magazine", {}},
      {"place mat", {}},
      {"notebook", {}},
      {"pen", {}},
      {"cell phone", {}},
      {"remote control", {}},
      {"calculator", {}},
      {"cable", {}},
      {"charger", {}},
      {"scissors", {}},
      {"stapler", {}},
      {"tape", {}},
      {"glasses", {}},
      {"ruler", {}},
      {"tissue box", {}},
      {"keys", {}},
      {"person", {}},
  };
  return classes;
}

std::size_t class_position(const std::string& class_name) {
  for (std::size_t i = 0; i < palette().size(); ++i)
    if (palette()[i].name == class_name) return i;
  throw Error(concat("furniture class '", class_name, "': no such class, did you mean '",
                     nearest_word(class_name, room_classes()), "'?"));
}

}  // namespace

const std::vector<std::string>& room_classes() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> made;
    for (const PaletteClass& entry : palette()) made.push_back(entry.name);
    return made;
  }();
  return names;
}

std::uint32_t room_class_id(const std::string& class_name) {
  return static_cast<std::uint32_t>(class_position(class_name)) + 1;
}

const std::vector<std::string>& models_of_class(const std::string& class_name) {
  return palette()[class_position(class_name)].models;
}

}  // namespace ovimap
